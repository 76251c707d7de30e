#pragma once

#include "slipfit/core/estimate.hpp"

namespace slipfit::fit {

/// Quantile of Student's t, by default that of a 95 % interval; fewer than 1 degree of freedom count as 1.
double t_quantile(double degrees_of_freedom, double probability = 0.975);

/// How often chance alone takes Student's t this far from 0, to either side.
double t_chance(double t, double degrees_of_freedom);

/// Value, standard error and symmetric 95 % interval.
Estimate symmetric(double value, double se, double degrees_of_freedom);

}  // namespace slipfit::fit
