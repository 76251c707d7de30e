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
  bool damped = false;  ///< zeta stays at 0 or above, in a search that a negative one would lead astray
};

/// Holds the weight of a cycle that is far worse than the others (SolveOptions::robust).
struct HuberWeight {
  double factor = 1.0;  ///< of its squares in the normal equations
  double sum = 0.0;     ///< in place of its sum of squares
};

/// Returns the weight of a cycle. `norm` is the root of the sum of squares of its `residuals` residuals; above a bound
/// it counts linearly.
inline HuberWeight huber_weight(double norm, std::size_t residuals) {
  const double bound = 3.0 * std::sqrt(static_cast<double>(residuals));
  if (!(norm > bound)) return {1.0, norm * norm};
  return {bound / norm, 2.0 * bound * norm - bound * bound};
}

}  // namespace slipfit::fit
