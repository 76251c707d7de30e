#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "fit/problem/block_fit.hpp"
#include "fit/selection/solution.hpp"

namespace slipfit::fit {

/// Asked once, with a fit of the cycles, or of some of them before all of many are fitted: true ends the fit, which is
/// then empty.
using AbortPredicate = std::function<bool(const BlockFit& some)>;

/// Returns the per-cycle block fit with all that real recordings require: several starts in zeta, a level that may
/// drift or wander, outliers left out. What finish_fit adds is missing: joined ramps, and more to the uncertainty. The
/// result is empty where fewer than 3 cycles can be fitted, or where no start converges.
std::optional<DampedFit> draft_damped(const FitInput& input, const AbortPredicate& should_abort = {});

/// All cycles without searching for outliers, bad slips or interference: how badly they fit, roughly.
std::optional<BlockFit> rough_fit(const FitInput& input);

/// The same cycles and level with zeta held at 0, from the damped solution. Where it `may_lose` and has clearly lost to
/// the damped fit, it stays rough and its ramps are not joined.
std::optional<DampedFit> fit_undamped(const DampedFit& damped, bool may_lose);

/// Those of the cycles that the fit has, in order.
std::vector<CycleData> same_cycles_of(const BlockFit& fit, std::vector<CycleData> cut);

/// Returns whether a level of its own in every cycle explains more than a polynomial of time does, by more than chance
/// explains. The two are fits of the same cycles.
bool level_wanders(const BlockFit& wandering, const BlockFit& polynomial);

}  // namespace slipfit::fit
