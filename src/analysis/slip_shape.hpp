#pragma once

#include <vector>

#include "slipfit/core/recording.hpp"
#include "slipfit/signal/cycles.hpp"
#include "slipfit/signal/quality.hpp"

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

/// Returns true if the rises between slips are round rather than straight: more of them are followed by half a cosine
/// than by a line. Each line and each cosine has its own two parameters, so that rises of any sizes and slopes count
/// alike.
bool rises_are_round(const Recording& recording, const Segmentation& segmentation);

/// Falls well above the noise and quicker than a sine's: counting them gives the frequency of slips, not of noise or
/// hum.
bool slips_stand_out(const Segmentation& segmentation);

}  // namespace slipfit
