#pragma once

#include <optional>

#include "fit/selection/solution.hpp"
#include "slipfit/core/estimate.hpp"

namespace slipfit::fit {

/// Profile likelihood of zeta: the sum of squares with zeta held and all else free.
struct DampingProfile {
  Interval interval;      ///< 95 %, zeta >= 0
  Coordinates move_low;   ///< of the coordinates, from the fit that was given to the low end
  Coordinates move_high;  ///< to the high end
};

/// Whether the sum of squares is no parabola over the interval of zeta: its standard error is large. Only where the
/// errors are those of white noise: a jackknife has no likelihood.
bool needs_profile(const DampedFit& fit);

/// `centre`: the best fit with zeta >= 0, from which the moves count. The interval holds the zeta in [0, 0.85] around
/// the best whose sum of squares lies above the smallest by at most the square of the quantile; where it reaches 0,
/// what lies below is cut off as in damping_interval. Empty where the fits with zeta held fail.
std::optional<DampingProfile> profile_damping(const DampedFit& fit, const BlockFit& centre);

}  // namespace slipfit::fit
