#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/statistics.hpp"
#include "slipfit/core/estimate.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/core/result.hpp"
#include "slipfit/signal/cycles.hpp"
#include "slipfit/signal/quality.hpp"
#include "slipfit/signal/spectrum.hpp"

namespace slipfit {

// What the shapes of the detected slips show, whatever model fits them.

/// Returns the median drop; 0 without slips.
double median_drop(const Segmentation& segmentation);

/// Returns the time between the middles of neighbouring slips, in s.
std::vector<double> slip_intervals_s(const Segmentation& segmentation);

/// Returns the median interval between slips in periods of the mains, 50 or 60 Hz, whichever is nearer; 0 below 2
/// slips.
double mains_share(const Segmentation& segmentation);

/// Returns the median ratio of the duration of a rise to that of the fall before it; 0 without rises.
double rise_over_fall(const Segmentation& segmentation);

/// Returns the ratio reduced by what the scatter of few ratios allows: the ratio that the motion proves.
double proven_rise_over_fall(const Segmentation& segmentation);

/// Returns the root mean square of the drops over the range from the lowest trough to the highest peak.
double swing_share(const Segmentation& segmentation);

/// Exponent by which the second differences of the force grow with their step, from an eighth of a fall on: 2 where a
/// body moves smoothly, 1.5 between straight sticks, 0.5 where the level walks at random, 0 in white noise.
double smoothness(const Recording& recording, const Quality& quality, const Segmentation& segmentation);

/// The distance of falls that are several intervals apart scatters by more than that of neighbours: each interval has
/// an error of its own, as slips have. The falls of hum keep the phase of a clock.
bool phase_wanders(const Segmentation& segmentation);

/// Falls at the frequency of the mains that keep its phase.
bool keeps_mains_phase(const Segmentation& segmentation);

/// Noise alone makes turning points of this size.
bool is_faint(const Segmentation& segmentation);

/// Falls as slow as those of a sine, over their period.
bool is_sine_like(const Segmentation& segmentation);

/// Intervals between the falls scatter no more than those of a repetition do.
bool keeps_rhythm(const Segmentation& segmentation);

/// Sudden falls after slow rises, in nearly all cycles: what makes stick-slip.
bool slips_are_sudden(const Segmentation& segmentation);

/// Slopes of the force from a trough to the next peak: over its middle three fifths, and from end to end [N/s].
struct Rise {
  double middle_N_per_s = 0.0;
  double whole_N_per_s = 0.0;
  double duration_s = 0.0;
};

/// Returns the rises between slips that have no gap, and samples enough for a slope of their middle.
std::vector<Rise> rises_of(const Recording& recording, const Segmentation& segmentation);

/// Returns true if the force wanders between most slips instead of rising: the body does not stick there.
bool rises_wander(const Recording& recording, const Segmentation& segmentation);

/// Returns true if the rises between slips are round rather than straight: more of them are followed by half a cosine
/// than by a line. Each line and each cosine has its own two parameters, so that rises of any sizes and slopes count
/// alike.
bool rises_are_round(const Recording& recording, const Segmentation& segmentation);

/// Falls well above the noise and quicker than a sine's: counting them gives the frequency of slips, not of noise or
/// hum.
bool slips_stand_out(const Segmentation& segmentation);

/// Intervals between slips, without the first slip, without gaps of the clock, and without the few that differ greatly
/// from otherwise regular ones (`broken`: the stage stopped, or samples are missing while the clock continued).
struct Intervals {
  std::vector<double> seconds;
  std::size_t broken = 0;
};

Intervals intervals_of(const Recording& recording, const Segmentation& segmentation);

/// Frequency from the mean interval between slips, in Hz; empty below 3 slips. The interval allows for slips that come
/// in clusters (or regularly): the variance of the mean is that of a stationary series, correlation of neighbours
/// included.
Estimate count_frequency(const Recording& recording, const Segmentation& segmentation);

/// Says how many intervals do not fit a regular rhythm; empty where all do.
std::optional<std::string> broken_rhythm(const Recording& recording, const Segmentation& segmentation);

/// Returns true if the interval between slips differs between two parts of the recording.
bool pace_changes(const Segmentation& segmentation);

/// Says how the interval or the drop changes at the moment that separates the values best; empty where their scatter
/// explains the change.
std::optional<std::string> change_on_the_way(const Segmentation& segmentation);

/// A part of a recording with its quality and slips.
struct Excerpt {
  Recording recording;
  Quality quality;
  Segmentation segmentation;
};

/// Properties of a recording that need no model: quality, slips and repetition frequency.
struct Signals {
  Quality quality;
  Segmentation segmentation;
  SpectralFrequency spectral;
};

/// The stretch of a recording that slides, with its quality and slips: the whole, where the user chose what to read. Of
/// values that a logger read more than once each is taken once. Refers to the recording that it was made of.
struct Detected {
  const Recording* whole = nullptr;
  std::optional<Recording> part;  ///< empty: the whole recording slides
  std::size_t begin = 0;          ///< first sample of the part
  std::vector<std::size_t> kept;  ///< samples of the recording that the part counts; empty: all of them
  Quality whole_quality;
  Signals signals;       ///< of the part; no spectrum yet
  double seconds = 0.0;  ///< that the detection took

  [[nodiscard]] const Recording& recording() const { return part ? *part : *whole; }
  /// The recording's sample that is number i of the part.
  [[nodiscard]] std::size_t sample_of(std::size_t i) const { return kept.empty() ? begin + i : kept[begin + i]; }
  /// Returns the number of samples of the recording that are averaged in one sample of the part; 1 if none are
  /// repeated.
  [[nodiscard]] double repeats() const {
    return kept.empty() ? 1.0 : static_cast<double>(whole->size()) / static_cast<double>(kept.size());
  }
};

Detected detect(const Recording& recording);

/// Wall-clock seconds since it was made.
class Stopwatch {
 public:
  [[nodiscard]] double elapsed_s() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace slipfit
