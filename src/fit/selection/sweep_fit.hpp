#pragma once

#include <optional>

#include "fit/problem/sweep_data.hpp"
#include "fit/selection/sweep_solution.hpp"
#include "slipfit/fit/options.hpp"

namespace slipfit::fit {

struct SweepFits {
  SweepSolution velocity;                ///< near enough to its minimum to compare sums of squares: see settled
  std::optional<SweepSolution> coulomb;  ///< with the same shares; empty: it has no minimum
  bool depends_on_speed = false;         ///< velocity explains more than chance would
  double p_value = 1.0;                  ///< that Coulomb friction gives such a difference by chance
};

/// Both laws, with everything shared between the recordings that the data agree with. Empty where no start converges.
std::optional<SweepFits> solve_sweep(const SweepData& data, const FitOptions& options);

}  // namespace slipfit::fit
