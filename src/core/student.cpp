#include "core/student.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace slipfit {

// Boost would work in long double, which takes its time, for digits that no interval needs.
using StudentsT =
    boost::math::students_t_distribution<double,
                                         boost::math::policies::policy<boost::math::policies::promote_double<false>>>;

double t_quantile(double degrees_of_freedom, double probability) {
  return boost::math::quantile(StudentsT(std::max(1.0, degrees_of_freedom)), probability);
}

double t_chance(double t, double degrees_of_freedom) {
  return 2.0 * boost::math::cdf(boost::math::complement(StudentsT(std::max(1.0, degrees_of_freedom)), std::abs(t)));
}

double students_factor(double degrees_of_freedom) {
  return t_quantile(std::max(2.0, degrees_of_freedom)) / kNormalQuantile;
}

Estimate symmetric(double value, double se, double degrees_of_freedom) {
  const double half = t_quantile(degrees_of_freedom) * se;
  return {value, se, Interval{value - half, value + half}, {}};
}

}  // namespace slipfit
