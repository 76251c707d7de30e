#pragma once

#include <cmath>
#include <cstddef>
#include <span>

#include "fit/coordinates.hpp"
#include "fit/problem/block_fit.hpp"

namespace slipfit::fit {

struct SolveOptions {
  Held held{};
  bool continuous = false;  ///< neighbouring cycles share their ramp (strong coupling, see kRampTolerance)
  int max_iterations = 60;
  /// Ends with the step that gains less than this much of one residual's share of the cost: 1e-3 leaves the parameters
  /// within a thousandth of a standard error (99 of 100 within 0.006), 0.1 is enough for a start.
  double tolerance = 1e-3;
  bool damped = false;  ///< zeta stays at 0 or above, in a search that a negative one would lead astray
};

/// Holds the weight of a cycle, of one that is far worse than the others so that it counts linearly, not squared.
struct HuberWeight {
  double factor = 1.0;  ///< of its squares in the normal equations
  double sum = 0.0;     ///< that replaces its sum of squares
};

/// Returns the weight of a cycle. `norm` is the root of the sum of squares of its `residuals` residuals; above a bound
/// it counts linearly.
inline HuberWeight huber_weight(double norm, std::size_t residuals) {
  const double bound = 3.0 * std::sqrt(static_cast<double>(residuals));
  if (!(norm > bound)) return {1.0, norm * norm};
  return {bound / norm, 2.0 * bound * norm - bound * bound};
}

/// Levenberg-Marquardt by Ceres from the recordings' parameters (what they share: the first one's); the cycles' own are
/// eliminated first (Elimination). A parameter that presses against an end of its range is held there while the others
/// go on, and let go where the sum falls inwards. Leaves the solution in all recordings. Returns the sum of squared
/// residuals, infinity where the start is outside the model.
double solve_together(std::span<BlockFit> recordings, const SweepTerms& sweep, const SolveOptions& options);
/// Solves for one recording by itself, as solve_together does.
double solve(BlockFit& fit, const SolveOptions& options);

}  // namespace slipfit::fit
