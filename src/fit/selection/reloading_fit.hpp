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

/// The damped fit, its sticks rising more steeply after a slip (level/reloading.hpp) where straight ones bend and the
/// rise is known and explains it. Before `finish_fit`.
std::optional<DampedFit> draft_with_rise(const Recording& recording, const Quality& quality,
                                         const Segmentation& segmentation, const HeldParameters& held);

/// With the rise over a given length, after slips that begin and end where `near`, another fit of the recording, has
/// them. Empty where the force falls after a slip in place of rising.
std::optional<DampedFit> draft_with_rise_over(double length_m, const Recording& recording, const Quality& quality,
                                              const Segmentation& segmentation, const HeldParameters& held,
                                              const DampedFit& near);

/// Twice the logarithm of the likelihood of one fit over that of another, each at its best noise.
double gain_of(const DampedFit& fit, const DampedFit& other);

}  // namespace slipfit::fit
