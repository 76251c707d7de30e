#pragma once

#include <memory>
#include <optional>

#include "fit/selection/solution.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/fit/parameter.hpp"
#include "slipfit/signal/cycles.hpp"
#include "slipfit/signal/quality.hpp"

namespace slipfit::fit {

/// The rise after slips that begin and end where `fit` has them, over this length.
std::shared_ptr<const RiseAfterSlip> reloading_of(const Recording& recording, const Segmentation& segmentation,
                                              const BlockFit& fit, double length_m, bool is_free);

/// The fit with sticks that rise more steeply after a slip (level/reloading.hpp), where `plain`, the fit with straight
/// ones, shows that they bend and the rise is known and explains it; else empty.
std::optional<DampedFit> fit_reloading(const Recording& recording, const Quality& quality,
                                       const Segmentation& segmentation, const HeldParameters& held,
                                       const DampedFit& plain);

/// The same over a length that is known; empty where the rise has no solution.
std::optional<DampedFit> fit_reloading_over(const Recording& recording, const Quality& quality,
                                            const Segmentation& segmentation, const HeldParameters& held,
                                            const DampedFit& plain, double length_m);

/// Twice the logarithm of the likelihood of one fit over that of another, each at its best noise.
double gain_of(const DampedFit& fit, const DampedFit& other);

}  // namespace slipfit::fit
