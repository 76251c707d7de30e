#pragma once

#include <optional>

#include "fit/problem/block_fit.hpp"

namespace slipfit::fit {

/// How much steeper a ramp begins (after a slip) than it ends (before the next): ln of the ratio of the slopes, with
/// the standard error over cycles. 0 for the model's straight sticks. Empty below 5 cycles with both halves.
struct RampBend {
  double log_ratio = 0.0;
  double standard_error = 0.0;
};
std::optional<RampBend> ramp_bend(const BlockFit& fit);

/// Rate (force a second) at which levels of their own rise from cycle to cycle, 0 where that is chance (3 standard
/// errors) or the level is a polynomial. A sensor that drifts adds it to every ramp, friction that changes does not.
double level_trend(const BlockFit& fit);

}  // namespace slipfit::fit
