#pragma once

#include <optional>

#include "fit/selection/damped_fit.hpp"

namespace slipfit::fit {

/// The damped fit, its sticks rising more steeply after a slip (level/level_model.hpp) where straight ones bend and the
/// rise is known and explains it. Before `finish_fit`.
std::optional<DampedFit> draft_with_rise(const FitInput& input, const AbortPredicate& should_abort = {});

/// Fits all cycles of `plain` with a rise of this length. Empty where the force then falls after a slip.
std::optional<DampedFit> draft_with_rise_over(double length_m, const FitInput& input, const DampedFit& plain);

}  // namespace slipfit::fit
