#pragma once

#include <optional>
#include <vector>

#include "fit/problem/block_fit.hpp"

namespace slipfit::fit {

/// Says how much steeper a ramp begins (after a slip) than it ends (before the next): ln of the ratio of the slopes,
/// with the standard error over cycles. It is 0 for the model's straight sticks, and empty below 5 cycles with both
/// halves.
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

}  // namespace slipfit::fit
