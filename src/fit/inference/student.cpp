#include "fit/inference/student.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>

namespace slipfit::fit {

double t_quantile(double degrees_of_freedom) {
  return boost::math::quantile(boost::math::students_t_distribution<double>(std::max(1.0, degrees_of_freedom)), 0.975);
}

Estimate symmetric(double value, double se, double degrees_of_freedom) {
  const double half = t_quantile(degrees_of_freedom) * se;
  return {value, se, Interval{value - half, value + half}, {}};
}

}  // namespace slipfit::fit
