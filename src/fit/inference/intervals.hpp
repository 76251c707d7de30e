#pragma once

#include "slipfit/core/estimate.hpp"

namespace slipfit::fit {

/// 97.5 % quantile of Student's t; fewer than 1 degree of freedom count as 1.
double t_quantile(double degrees_of_freedom);

/// zeta cannot be negative: the part of the estimate's distribution below 0 is cut off. Where 0 is inside the interval,
/// the upper end leaves 5 % of the rest above it.
Interval damping_interval(double zeta, double se, double quantile);

/// Value, standard error and symmetric 95 % interval.
Estimate symmetric(double value, double se, double degrees_of_freedom);

/// From a logarithm (value, error and interval given) to the quantity itself.
Estimate exponential(const Estimate& logarithm);

}  // namespace slipfit::fit
