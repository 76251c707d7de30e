#include "fit/inference/intervals.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace slipfit::fit {

double t_quantile(double degrees_of_freedom) {
  return boost::math::quantile(boost::math::students_t_distribution<double>(std::max(1.0, degrees_of_freedom)), 0.975);
}

Interval damping_interval(double zeta, double se, double quantile) {
  if (zeta - quantile * se > 0.0) return {zeta - quantile * se, zeta + quantile * se};
  const boost::math::normal_distribution<double> normal(zeta, se);
  const double above_zero = boost::math::cdf(boost::math::complement(normal, 0.0));
  if (!(above_zero > 1e-12)) return {0.0, se};
  return {0.0, boost::math::quantile(boost::math::complement(normal, 0.05 * above_zero))};
}

Estimate symmetric(double value, double se, double degrees_of_freedom) {
  const double half = t_quantile(degrees_of_freedom) * se;
  return {value, se, Interval{value - half, value + half}, {}};
}

Estimate exponential(const Estimate& logarithm) {
  const double value = std::exp(*logarithm.value);
  return {value,
          value * *logarithm.standard_error,
          Interval{std::exp(logarithm.ci95->low), std::exp(logarithm.ci95->high)},
          {}};
}

}  // namespace slipfit::fit
