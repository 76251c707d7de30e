#pragma once

#include <span>

#include "fit/problem/block_fit.hpp"
#include "fit/problem/solve_options.hpp"

namespace slipfit::fit {

/// Levenberg-Marquardt by Ceres from the recordings' parameters (what they share: the first one's); the cycles' own are
/// eliminated first (Elimination). Leaves the solution in all of them. Returns the sum of squared residuals, infinity
/// where the start is outside the model.
double solve_together(std::span<BlockFit> recordings, const SweepTerms& sweep, const SolveOptions& options);
/// Solves for one recording by itself, as solve_together does.
double solve(BlockFit& fit, const SolveOptions& options);

}  // namespace slipfit::fit
