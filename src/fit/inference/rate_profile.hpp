#pragma once

#include "fit/inference/sweep_coordinates.hpp"

namespace slipfit::fit {

/// Holds the best coordinates and their spread along alpha. If alpha is known badly the sum of squares is no parabola
/// along it: alpha times zeta is known better than either, and a second minimum may have the other sign. The spread is
/// then from refits with alpha held, out to where the sum of squares has risen by the square of Student's quantile, and
/// from what `spread` says. Where alpha is known well, or held, it is from `spread` alone. `best` is the solution's
/// coordinates. A negative zeta is moved to the best of the profile with zeta >= 0, and the profile leads from there to
/// the others of these.
struct AlongRate {
  Coordinates best;
  Spread spread;
};
AlongRate profile_rate(const SweepSolution& solution, const StaticFriction& kind, const Coordinates& best,
                       const Spread& spread);

}  // namespace slipfit::fit
