#pragma once

#include <Eigen/Core>

#include "fit/inference/uncertainty.hpp"

namespace slipfit::fit {

/// Returns the moves of the coordinates by leaving out one stretch of the slips (misfit.hpp): a row for each stretch
/// without which the shared parameters can still be determined. It takes one Gauss-Newton step from the solution
/// instead of a refit: within a tenth of it, where the result is a spread that widens intervals. Joined ramps are let
/// go, which makes the moves larger if anything.
Moves influence_of_segments(const BlockFit& fit, const Held& held);

}  // namespace slipfit::fit
