#pragma once

#include <optional>

#include "fit/selection/damped_fit.hpp"

namespace slipfit::fit {

/// The damped fit, its sticks rising more steeply after a slip (level/reloading.hpp) where straight ones bend and the
/// rise is known and explains it. Before `finish_fit`.
std::optional<DampedFit> draft_with_rise(const FitInput& input, const GiveUp& give_up = {});

/// The same cycles at the same parameters, their rise after slips that begin and end where `fit` has them, as a sensor
/// of these scales sees it.
BlockFit with_rise_after(const BlockFit& fit, const Scales& scales);

/// The same with the rise over so many times its length. Without a rise `fit` as it is.
BlockFit with_length_times(const BlockFit& fit, double times);

/// The same over the length that Newton's step leads to, where it is free.
BlockFit with_next_length(const BlockFit& fit);

/// The force rises after slips, or has no rise there.
bool rises(const BlockFit& fit);

/// The fit of the same cycles under the same law, its rise settled: its length, and the slips that it comes after.
/// Empty where the data do not sample it. Without a rise `fit` as it is.
std::optional<DampedFit> settle_rise(const FitInput& input, std::optional<DampedFit> fit);

/// A solution with its uncertainty, its rise settled. Empty where the data do not tell the parameters apart or do not
/// sample the rise.
std::optional<DampedFit> finish_settled(const FitInput& input, DampedFit fit);

/// The fit with its rise over a length that is free, settled. Empty where it has none or the data do not tell it.
std::optional<DampedFit> with_free_rise(const FitInput& input, const DampedFit& fit);

/// With the rise over a given length, after slips that begin and end where `near`, another fit of the recording, has
/// them. Empty where the force falls after a slip in place of rising.
std::optional<DampedFit> draft_with_rise_over(double length_m, const FitInput& input, const DampedFit& near);

}  // namespace slipfit::fit
