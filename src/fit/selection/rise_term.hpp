#pragma once

#include <optional>

#include "fit/selection/damped_fit.hpp"
#include "fit/selection/rise.hpp"

namespace slipfit::fit {

/// The damped fit, before `finish_fit`.
struct RiseDraft {
  /// Its sticks rise more steeply after a slip (level/level_model.hpp) where the data determine the rise.
  DampedFit fit;
  /// The same fit with a rise that explains more, but that the data do not determine without more terms. `fit` has
  /// none then.
  std::optional<DampedFit> unproven{};
  RampBend bend{};  ///< of the sticks of `fit`, where `unproven` has a value
};

/// Returns the damped fit, with a rise where straight sticks bend, the rise is known and explains it.
std::optional<RiseDraft> draft_with_rise(const FitInput& input, const AbortPredicate& should_abort = {});

/// Returns whether a fit with the rise of `draft` and more terms shows that there is one.
bool proves_rise(const DampedFit& fit, const RiseDraft& draft);

/// Fits all cycles of `plain` with a rise of this length. Empty where the force then falls after a slip.
std::optional<DampedFit> draft_with_rise_over(double length_m, const FitInput& input, const DampedFit& plain);

}  // namespace slipfit::fit
