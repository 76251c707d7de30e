#pragma once

#include <cmath>
#include <cstddef>

#include "fit/coordinates.hpp"

namespace slipfit::fit {

struct SolveOptions {
  Held held{};
  bool continuous = false;  ///< neighbouring cycles share their ramp (strong coupling, see kRampTolerance)
  bool robust = false;      ///< a cycle far worse than the others counts linearly, not squared
  int max_iterations = 60;
  /// Ends with the step that gains less than this much of one residual's share of the cost: 1e-3 leaves the parameters
  /// within a thousandth of a standard error (99 of 100 within 0.006), 0.1 is enough for a start.
  double tolerance = 1e-3;
};

/// SolveOptions::robust: a cycle whose residuals' root of the sum of squares is beyond it counts linearly.
inline double huber_bound(std::size_t residuals) {
  return 3.0 * std::sqrt(static_cast<double>(residuals));
}

}  // namespace slipfit::fit
