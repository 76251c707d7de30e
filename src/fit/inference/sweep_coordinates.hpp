#pragma once

#include "fit/inference/ageing_line.hpp"
#include "fit/inference/intervals.hpp"
#include "fit/selection/sweep_solution.hpp"

namespace slipfit::fit {

/// The coordinates of a sweep at its solution: levels and differences of their own are means over the recordings, or a
/// line through them where static friction ages.
Coordinates coordinates_of(const SweepSolution& solution, const StaticFriction& kind);

/// White noise, or the jackknife over cycles where residuals of a recording correlate; scatter of the recordings' own
/// levels and differences included.
Spread spread_of(const SweepData& data, const SweepSolution& solution, const std::vector<Normal>& normals,
                 const StaticFriction& kind);

/// Adds the uncertainty of the cut-off of ageing. Its distribution gives its range by itself, so that Student's t of
/// the spread, with its final degrees of freedom, is divided out.
void add_cutoff(const SweepSolution& solution, const StaticFriction& kind, Spread& spread);

/// zeta cannot be negative: where its best value is, the best values given zeta = 0 (by the covariance, to second
/// order).
Coordinates with_damping_cut(const Coordinates& values, const CoordinateMatrix& covariance);

}  // namespace slipfit::fit
