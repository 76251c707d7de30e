#pragma once

#include <optional>

#include "fit/problem/sweep_data.hpp"
#include "fit/selection/sweep_solution.hpp"
#include "slipfit/fit/options.hpp"

namespace slipfit::fit {

struct SweepFits {
  SweepSolution velocity;                ///< near enough to its minimum to compare sums of squares: see settled
  std::optional<SweepSolution> coulomb;  ///< sharing at most what velocity does; empty: it has no minimum
  /// Holds the same fit as `coulomb`, with k that depends on the speed; empty where one k of all explains the
  /// recordings, or too few show it.
  std::optional<SweepSolution> growing{};
  double coulomb_chi2 = 0.0;      ///< with the shares of velocity
  double p_value = 0.0;           ///< that Coulomb friction with these gives such a difference by chance
  bool depends_on_speed = false;  ///< velocity explains more than chance would
};

/// Says how a fit of the rig is done.
enum class RigFit {
  Sharp,
  Rough,          ///< near enough to the minimum to compare starts
  StiffnessGrows  ///< sharp, with k that varies with the speed
};

/// Fits Coulomb friction that the recordings do not share: they share the rig alone. Empty without a minimum.
std::optional<SweepSolution> fit_rig(const SweepData& data, const HeldParameters& held, RigFit kind = RigFit::Sharp);

/// Both laws, with everything shared between the recordings that the data agree with. Empty where no start converges.
std::optional<SweepFits> solve_sweep(const SweepData& data, const FitOptions& options);

}  // namespace slipfit::fit
