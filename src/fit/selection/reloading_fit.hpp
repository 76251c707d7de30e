#pragma once

#include <optional>

#include "fit/selection/damped_fit.hpp"

namespace slipfit::fit {

/// The damped fit, its sticks rising more steeply after a slip (level/reloading.hpp) where straight ones bend and the
/// rise is known and explains it. Before `finish_fit`.
std::optional<DampedFit> draft_with_rise(const FitInput& input, const GiveUp& give_up = {});

/// The same cycles at the same parameters, their rise after slips that begin and end where `fit` has them.
BlockFit with_rise_after(const BlockFit& fit);

/// The same with a free length of the rise, where there is one.
BlockFit with_free_rise(const BlockFit& fit);

/// The force rises after slips, or has no rise there.
bool rises(const BlockFit& fit);

/// The fit of the same cycles under the same law, its rise settled: its length, and the slips that it comes after.
/// Empty where the data do not sample it. Without a rise `fit` as it is.
std::optional<DampedFit> settle_rise(const FitInput& input, std::optional<DampedFit> fit);

/// A solution with its uncertainty, its rise settled. Empty where the data do not tell the parameters apart or do not
/// sample the rise.
std::optional<DampedFit> finish_settled(const FitInput& input, DampedFit fit);

/// With the rise over a given length, after slips that begin and end where `near`, another fit of the recording, has
/// them. Empty where the force falls after a slip in place of rising.
std::optional<DampedFit> draft_with_rise_over(double length_m, const FitInput& input, const DampedFit& near);

}  // namespace slipfit::fit
