#pragma once

#include <functional>
#include <optional>

#include "fit/selection/fit_input.hpp"
#include "fit/selection/solution.hpp"

namespace slipfit::fit {

/// Asked once, before all of many cycles are fitted, with the fit of some of them: true ends the fit, which is then
/// empty.
using AbortPredicate = std::function<bool(const BlockFit& some)>;

/// Returns the per-cycle block fit with all that real recordings require: several starts in zeta, a level that may
/// drift or wander, outliers left out. What finish_fit adds is missing: joined ramps, and more to the uncertainty. The
/// result is empty where fewer than 3 cycles can be fitted, or where no start converges.
std::optional<DampedFit> draft_damped(const FitInput& input, const AbortPredicate& should_abort = {});

/// All cycles with no sample, no slip and no line looked for: how badly they fit, roughly.
std::optional<BlockFit> rough_fit(const FitInput& input);

/// The same cycles and level with zeta held at 0, from the damped solution. Where it `may_lose` and has clearly lost to
/// the damped fit, it stays rough and its ramps are not joined.
std::optional<DampedFit> fit_undamped(const DampedFit& damped, bool may_lose);

}  // namespace slipfit::fit
