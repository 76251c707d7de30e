#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "fit/coordinates.hpp"
#include "fit/cycle/sensor.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/fit/result.hpp"
#include "slipfit/signal/cycles.hpp"
#include "slipfit/signal/quality.hpp"

namespace slipfit::fit {

/// Returns whether work on so many samples is worth the start of a second thread. Their residuals take 3 ms at the
/// limit. Below it threads take as long to start and to share the cache as they save.
inline bool pays_side_by_side(std::size_t samples) {
  constexpr std::size_t kLarge = 60000;
  return samples >= kLarge && usable_processors() > 1;
}

/// Calls f(begin, end) for ranges of neighbouring cycles that together make [0, cycles): side by side where the cycles
/// have so many samples together that a second thread is worth its start, else once. `f` must not change what another
/// range reads or writes; sums over cycles are to be formed afterwards, in the order of the cycles.
template <class F>
void for_cycles(std::size_t cycles, std::size_t samples, const F& f) {
  constexpr std::size_t kRanges = 16;  // several for each processor: others may use one of them, too
  if (cycles == 0) return;
  for_ranges(cycles, pays_side_by_side(samples) ? 1 + cycles / kRanges : cycles, f);
}

/// Holds what the cycles of several recordings have in common: each cycle's own onset force and level are draws from
/// it.
struct Population {
  double load = 1.0;      ///< normal force over that of the reference: friction is proportional to it
  double force = 1.0;     ///< unit of the recording's level and friction difference: Units::force times the load
  double onset_sd = 1.0;  ///< spread of F_s over the cycles
  /// Spread with which a cycle's own level follows F_k(0+); 0 where the level is common to the cycles.
  double level_sd = 0.0;
  double slip_speed_m_per_s = 1.0;  ///< Units::slip_speed_m_per_s
  /// Logarithm of the speed over Units::speed_m_per_s where k varies with the speed; it is empty otherwise.
  std::optional<double> log_speed{};
};

/// The time of the sensor that a fit solves for, if any.
enum class FreeTime { None, Lag, Average };

/// Holds the times of a sensor: by how much its low-pass filter of some order delays a slow ramp (the lag T of first
/// order) and the time W over which it averages; 0 means none.
struct SensorTimes {
  double lag_s = 0.0;
  double average_s = 0.0;
  std::size_t order = 1;

  [[nodiscard]] Sensor in_tau(double omega_rad_per_s) const {
    return {omega_rad_per_s * lag_s, omega_rad_per_s * average_s, order};
  }
};

/// Returns for how long before or after a slip such a sensor still shows it, in s. A filter decays to e^-8:
/// the slowest pole of a Butterworth response has its delay as time constant.
inline double shown_beyond_s(const SensorTimes& sensor) {
  return kForgottenLags * sensor.lag_s + 0.5 * sensor.average_s;
}

/// Holds the typical cycle of a recording on a spring that relaxes, from which the force that is still relaxing at an
/// onset follows. Its times are in units of 1 / w_n, at the w_n that the fit begins with.
struct RelaxingCycles {
  double slip = 1.0;
  double period = 1.0;
  double longest_s = 0.0;  ///< the fit ends with this time of relaxation at most
};

/// Describes how a recording enters a fit: the scales that make its numbers of order one, and how its samples see a
/// slip.
struct Scales {
  double speed_m_per_s = 1.0;
  double force = 1.0;         ///< typical half drop
  double level = 0.0;         ///< typical middle of the slips
  double noise = 1.0;         ///< residuals are divided by it
  double time_begin_s = 0.0;  ///< of the cycles in the fit: the drift polynomial lives on [begin, end]
  double time_end_s = 1.0;
  ForceView view = ForceView::Spring;   ///< spring or transmitted: what the samples show of a slip
  double sensor_lag_s = 0.0;            ///< SensorTimes::lag_s; 0: the sensor shows the force as it is
  std::size_t sensor_order = 1;         ///< SensorTimes::order
  double sensor_average_s = 0.0;        ///< W: each sample is the mean over this time around its time stamp
  FreeTime free_time = FreeTime::None;  ///< T or W may be a parameter of the fit, which then gives its value
  double sensor_time_unit_s = 1.0;      ///< of that parameter, (time / unit)^2: what slips show of it is linear in that
  double half_period_s = 1.0;           ///< from the largest to the smallest force of a slip, pi / (w_n b)
  FrictionLaw law = FrictionLaw::Coulomb;
  double slip_distance_m = 1.0;              ///< Units::slip_distance_m
  bool stiffness_drifts = false;             ///< k changes along the path: kStiffnessDrift
  std::optional<RelaxingCycles> relaxing{};  ///< the spring relaxes (docs/model.md section 10); empty: it does not
  std::optional<Population> population{};    ///< of a sweep

  /// Returns the place of a time along the path of the cycles, from -1 to 1.
  [[nodiscard]] double place_at(double time_s) const {
    return 2.0 * (time_s - time_begin_s) / (time_end_s - time_begin_s) - 1.0;
  }
  /// Force at which the level's constant counts 0, and its unit.
  [[nodiscard]] double level_zero() const { return population ? 0.0 : level; }
  [[nodiscard]] double level_unit() const { return population ? population->force : force; }
};

/// Holds the mean and the least-squares slope of a mains line's cosine and sine over the samples of a bin.
struct LineInBin {
  std::array<double, 2> mean{};
  std::array<double, 2> slope{};
};

/// Samples of a straight stretch of stick, reduced without loss to their centred sums: a line enters a least-squares
/// fit only through them.
struct StickBin {
  double count = 0.0;
  double time_s = 0.0;           ///< mean
  double force = 0.0;            ///< mean
  double slope = 0.0;            ///< least-squares slope
  double time_spread = 0.0;      ///< sum of squared distances from the mean time, s^2
  double scatter = 0.0;          ///< sum of squares about the line
  std::vector<LineInBin> lines;  ///< one for each line of HumLines
};

/// Mains lines whose share in the stick bins is wanted; phases count from `begin_s`.
struct HumLines {
  std::vector<double> frequencies_Hz;
  double begin_s = 0.0;
  /// Force of every sample without the lines, about which bins scatter; empty where it is not known.
  std::vector<double> force_without_lines{};
};

/// One cycle of the fit: a slip with half of the ramp on either side.
struct CycleData {
  std::size_t slip = 0;  ///< index into the segmentation
  double window_begin_s = 0.0;
  double window_end_s = 0.0;
  std::vector<std::size_t> samples;  ///< around the slip, each one fitted; stick bins hold the rest
  std::vector<double> time_s;
  std::vector<double> force;
  std::vector<double> weight;  ///< of the residuals of `samples`; empty: all 1
  std::vector<StickBin> bins_before;
  std::vector<StickBin> bins_after;
  bool continuous_with_next = false;  ///< the next slip of the recording is in the fit too, no gap between

  [[nodiscard]] std::size_t residuals() const { return time_s.size() + 2 * (bins_before.size() + bins_after.size()); }
};

/// Returns the index of the first sample at this time or later; the number of samples where there is none.
inline std::size_t index_at(std::span<const double> times_s, double time_s) {
  return static_cast<std::size_t>(std::ranges::lower_bound(times_s, time_s) - times_s.begin());
}

/// Neighbours, whose joined ramps halve the error of k.
constexpr std::size_t kCyclesOfRun = 8;

/// Selects the slips that are offered to the fit. These are all slips or, where there are many, some 512 with 16
/// samples in the fall from 80 to 20 %. Slips with more samples are fewer, down to 128, because each holds more
/// information and costs more time. They are runs of neighbours from the first to the last, at uneven distances, so
/// that a line in the force has no images. With so many slips the noise rarely limits the shared parameters, and the
/// time of a fit grows no more.
class OfferedSlips {
 public:
  OfferedSlips(std::size_t slips, double samples_in_fall);

  [[nodiscard]] bool has(std::size_t slip) const;

 private:
  std::size_t all_;   ///< runs
  std::size_t most_;  ///< of them that are taken
};

OfferedSlips offered_slips(const Recording& recording, const Segmentation& segmentation);

/// Cuts the recording into cycles, those that are selected for the fit. `excluded` (in ascending order) leaves out
/// impulses, clipped samples and outliers. The first slip starts from rest and is left out; so is a slip with a gap
/// in it or without ramp samples. Samples within `half_width_s` of a slip's middle are kept one by one, the rest goes
/// into bins.
std::vector<CycleData> cut_cycles(const Recording& recording, const Segmentation& segmentation, double half_width_s,
                                  const std::vector<std::size_t>& excluded, const HumLines& hum = {});

/// Cuts the recording as cut_cycles does, with `force` as the force of its samples.
std::vector<CycleData> cut_cycles_of(std::span<const double> force, const Recording& recording,
                                     const Segmentation& segmentation, double half_width_s,
                                     const std::vector<std::size_t>& excluded, const HumLines& hum = {});

/// Returns the cycle with some 20 samples in a half period of its slip, enough for its shape, and fewer at more than
/// two half periods from its middle, where the curve is smooth. Sticks remain as they are. `step_s` is the step of the
/// clock.
CycleData thinned(CycleData cycle, double middle_s, double half_period_s, double step_s);

/// Returns the indices of at most `most` of `count` cycles, evenly spread from the first to the last. `most`: at
/// least 2.
std::vector<std::size_t> spread_indices(std::size_t count, std::size_t most);

/// Returns the cycles at these indices, at most `size` of them.
std::vector<CycleData> spread_subset(const std::vector<CycleData>& cycles, std::size_t size);

/// Holds the times within a stick bin at which a smooth curve gives its mean and its least-squares slope over the
/// samples of the bin, taken as evenly spread: Gauss's nodes over a width whose centred square is that of the samples.
class BinNodes {
 public:
  struct Node {
    double time_s = 0.0;
    double mean = 0.0;         ///< share of the value in the mean
    double slope_per_s = 0.0;  ///< of the value in the slope
  };

  explicit BinNodes(const StickBin& bin) {
    nodes_[0] = {bin.time_s, 1.0, 0.0};
    if (bin.count < 2.0 || !(bin.time_spread > 0.0)) return;
    constexpr std::array kPlaces{0.5384693101056831, 0.9061798459386640};
    constexpr std::array kWeights{0.4786286704993665, 0.2369268850561891};
    constexpr double kMiddle = 0.5688888888888889;
    nodes_[0].mean = 0.5 * kMiddle;
    const double half_s = std::sqrt(3.0 * bin.time_spread / bin.count);
    for (std::size_t i = 0; i < kPlaces.size(); ++i) {
      for (const double side : {-1.0, 1.0}) {
        nodes_[count_++] = {bin.time_s + side * half_s * kPlaces[i], 0.5 * kWeights[i],
                            side * 1.5 * kWeights[i] * kPlaces[i] / half_s};
      }
    }
  }

  [[nodiscard]] std::span<const Node> nodes() const& { return {nodes_.data(), count_}; }
  [[nodiscard]] std::span<const Node> nodes() const&& = delete;

 private:
  std::array<Node, 5> nodes_{};
  std::size_t count_ = 1;
};

/// A row for each detected slip, without what a fit adds.
std::vector<Cycle> detected_cycles(const Recording& recording, const Segmentation& segmentation);

}  // namespace slipfit::fit
