#pragma once

#include <boost/math/tools/toms748_solve.hpp>
#include <cstdint>

namespace slipfit::model {

/// The root of a function that changes its sign between `low` and `high`, to rounding.
template <class F>
double root_between(const F& f, double low, double high) {
  const double at_low = f(low);
  const double at_high = f(high);
  if (at_low == 0.0) return low;
  if (!(at_low * at_high < 0.0)) return high;
  std::uintmax_t evaluations = 60;
  const auto bracket = boost::math::tools::toms748_solve(f, low, high, at_low, at_high,
                                                         boost::math::tools::eps_tolerance<double>(52), evaluations);
  return 0.5 * (bracket.first + bracket.second);
}

}  // namespace slipfit::model
