#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "fit/problem/block_fit.hpp"
#include "fit/selection/solution.hpp"

namespace slipfit::fit {

/// Returns the slope of the level at a time of a cycle. A drift that bends makes a ramp steeper than the one before it.
double level_slope(const BlockFit& fit, std::size_t cycle, double time_s);

/// Says how much steeper a ramp begins (after a slip) than it ends (before the next): ln of the ratio of the slopes,
/// with the standard error over cycles, longer where they are few: chance exceeds kClearSigmas of it in 0.3 %. It is 0
/// for the model's straight sticks, and empty below 5 cycles with both halves.
struct RampBend {
  double log_ratio = 0.0;
  double standard_error = 0.0;
};
std::optional<RampBend> ramp_bend(const BlockFit& fit);
/// The same within the second half of the ramps, which creep before a slip bends.
std::optional<RampBend> late_bend(const BlockFit& fit);

/// Returns for every cycle the mean of its sticks, before and after the slip, above the model: how its level differs
/// from the fitted one.
std::vector<double> level_offsets(const BlockFit& fit);

/// Share of the slope of the level polynomial that the sticks contain: 1 where a sensor drifts, 0 where friction
/// changes. Known where that slope changes over the recording. Empty below 5 cycles, and where the level is no
/// polynomial of second order or more.
struct RampDrift {
  double share = 0.0;
  double standard_error = 0.0;
  double level_rate = 0.0;  ///< mean slope of the polynomial over the sticks, weighted as they determine k; force/s
};
std::optional<RampDrift> drift_in_ramps(const BlockFit& fit);

/// Share of a stick: over a longer path a rise cannot be distinguished from a softer spring.
inline constexpr double kLongestRise = 0.5;

/// `fit` with a rise over this length after all slips of the recording, which begin and end where `slips`, a fit of all
/// cycles, has them.
BlockFit with_rise_over(double length_m, const FitInput& input, const BlockFit& slips, const BlockFit& fit);

/// The same cycles at the same parameters, their rise after slips that begin and end where `fit` has them.
BlockFit with_rise_after(const BlockFit& fit);

/// The same with a free length of the rise, where there is one.
BlockFit with_free_rise(const BlockFit& fit);

/// The force rises after slips, or has no rise there.
bool rises(const BlockFit& fit);

/// Length of the rise of a fit that has one.
double rise_length_m(const DampedFit& fit);

/// The fit of the same cycles under the same law, its rise settled: its length, and the slips that it comes after.
/// Empty where the data do not sample it. Without a rise `fit` as it is.
std::optional<DampedFit> settle_rise(const FitInput& input, std::optional<DampedFit> fit);

/// Returns a solution with its uncertainty, its rise settled. The result is empty where the data do not distinguish the
/// parameters or do not sample the rise.
std::optional<DampedFit> finish_settled(const FitInput& input, DampedFit fit);

}  // namespace slipfit::fit
