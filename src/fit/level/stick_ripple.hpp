#pragma once

#include <optional>

#include "fit/problem/block_fit.hpp"
#include "fit/selection/outliers.hpp"
#include "slipfit/core/recording.hpp"

namespace slipfit::fit {

/// One line in the sticks: a drive that runs unevenly (V (1 + r cos w t) gives a force k V r / w in stick), or pick-up.
struct StickRipple {
  double frequency_Hz = 0.0;
  double force = 0.0;          ///< amplitude, in the column's unit
  double speed_share = 0.0;    ///< amplitude of the speed that makes it, over the driving speed
  double log_stiffness = 0.0;  ///< by how much ln k changes where the sticks are fitted with the line
};

/// The largest line in what a fit leaves of the sticks, between 2.5 and 30 times the slips' frequency. Empty where the
/// periodogram's largest value is chance (thresholds::kRippleChance), where the line does not last all the stick, or
/// below `least_force`: steps of the converter make lines of half their height in straight ramps.
/// `residuals`: of all samples of the recording.
std::optional<StickRipple> find_stick_ripple(const Recording& recording, const BlockFit& fit,
                                             const Residuals& residuals, double least_force);

/// Amplitude of the drive's speed that makes a line of this amplitude in stick, over the driving speed.
double speed_share(const BlockFit& fit, double frequency_Hz, double force);

}  // namespace slipfit::fit
