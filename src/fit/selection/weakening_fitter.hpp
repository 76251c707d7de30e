#pragma once

#include <optional>
#include <vector>

#include "fit/selection/weakening_solver.hpp"

namespace slipfit::fit {

/// `missed`: stacked residual of the Coulomb fit, where the law is to be taken for halving it alone; empty: it is
/// fitted to all cycles, whatever some of them show. Empty where no start converges, where some of the cycles show that
/// it will not be taken or where the cycles do not tell the shared parameters apart.
std::optional<DampedFit> fit_weakening(const FitInput& input, const DampedFit& coulomb, std::optional<double> missed);

/// Fits from the minima of some of the cycles.
struct AveragedWeakenings {
  std::vector<DampedFit> fits{};
  bool is_complete = true;  ///< false: from one of the minima on nothing settled, which says nothing against it
};

/// The same seen through an average of the sensor that is one parameter more: the minimum that explains some of the
/// cycles best, and the next one where some of the cycles do not rule it out. Without those that have no slip distance.
AveragedWeakenings fit_averaged_weakening(const FitInput& input, const DampedFit& coulomb);

}  // namespace slipfit::fit
