#pragma once

#include <limits>

#include "slipfit/core/estimate.hpp"

namespace slipfit {

/// Quantile of the normal distribution for a 95 % interval.
inline constexpr double kNormalQuantile = 1.959963985;

/// Quantile of Student's t, by default that of a 95 % interval; fewer than 1 degree of freedom count as 1.
double t_quantile(double degrees_of_freedom, double probability = 0.975);

/// Returns the probability that chance alone gives a Student's t at least this far from 0, on either side.
double t_chance(double t, double degrees_of_freedom);

/// Returns the factor by which a standard error with few degrees of freedom, at least 2, grows so that kNormalQuantile
/// of it covers 95 %.
double students_factor(double degrees_of_freedom);

/// Returns an estimate with a symmetric 95 % interval, by default that of the normal distribution.
Estimate symmetric(double value, double se, double degrees_of_freedom = std::numeric_limits<double>::infinity());

}  // namespace slipfit
