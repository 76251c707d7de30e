#pragma once

#include <optional>
#include <vector>

#include "fit/inference/misfit.hpp"
#include "fit/inference/uncertainty.hpp"
#include "fit/problem/block_fit.hpp"
#include "slipfit/fit/parameter.hpp"
#include "slipfit/signal/cycles.hpp"
#include "slipfit/signal/quality.hpp"

namespace slipfit::fit {

/// The block fit of a recording and what it was reached with.
struct DampedFit {
  BlockFit blocks;
  bool continuous = false;  ///< ramps shared by neighbouring cycles: the data agree with it
  Held held;
  /// Free damping ratio where it came out clearly negative: the slip is not shaped like the model's, zeta is held at 0.
  std::optional<double> refused_damping;
  std::vector<std::size_t> excluded;  ///< samples in ascending order: impulses, clipped, outliers
  Uncertainty uncertainty;
  std::optional<PhaseMisfit> misfit;  ///< slips are not shaped like the model's; the covariances allow for it
};

/// The per-cycle block fit with all that makes it stand real recordings: several starts in zeta, a level that may
/// drift or wander, outliers left out, ramps joined where the data allow it. Empty: fewer than 3 cycles to fit, or no
/// start converges.
std::optional<DampedFit> fit_damped(const Recording& recording, const Quality& quality,
                                    const Segmentation& segmentation, const HeldParameters& held);

/// The same cycles and level with zeta held at 0, from the damped solution. Where it `may_lose` and has clearly lost to
/// the damped fit, it stays rough and its ramps are not joined.
std::optional<DampedFit> fit_undamped(const DampedFit& damped, bool may_lose);

}  // namespace slipfit::fit
