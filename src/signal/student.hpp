#pragma once

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>

namespace slipfit::signal {

/// 97.5 % quantile of Student's t over that of the normal distribution: a standard error from few degrees of freedom,
/// multiplied by it, covers 95 % with 1.96. Fewer than 2 degrees of freedom count as 2.
inline double students_factor(double freedom) {
  const double nu = std::max(2.0, freedom);
  // P(|t| > q) = I_x(nu/2, 1/2) with x = nu / (nu + q^2).
  const double x = boost::math::ibeta_inv(0.5 * nu, 0.5, 0.05);
  return std::sqrt(nu / x - nu) / 1.959963985;
}

}  // namespace slipfit::signal
