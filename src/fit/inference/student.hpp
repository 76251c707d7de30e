#pragma once

#include "slipfit/core/estimate.hpp"

namespace slipfit::fit {

/// 97.5 % quantile of Student's t; fewer than 1 degree of freedom count as 1.
double t_quantile(double degrees_of_freedom);

/// Value, standard error and symmetric 95 % interval.
Estimate symmetric(double value, double se, double degrees_of_freedom);

}  // namespace slipfit::fit
