#pragma once

#include <boost/math/tools/roots.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cstdint>
#include <tuple>

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

/// The same of a function that returns its value and first two derivatives in a tuple, searched from `guess`.
template <class F>
double root_near(const F& f, double guess, double low, double high) {
  constexpr int kDigits = 18;  // of the last step, in bits: the error that it leaves is of its third power
  std::uintmax_t evaluations = 60;
  try {
    return boost::math::tools::halley_iterate(f, guess, low, high, kDigits, evaluations);
  } catch (const boost::math::evaluation_error&) {
    // Rounding may give f the same sign at both ends.
    return root_between([&](double x) { return std::get<0>(f(x)); }, low, high);
  }
}

}  // namespace slipfit::model
