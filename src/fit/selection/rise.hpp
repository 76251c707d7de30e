#pragma once

#include <optional>

#include "fit/selection/fit_input.hpp"
#include "fit/selection/solution.hpp"

namespace slipfit::fit {

/// Share of a stick: over a longer path a rise cannot be distinguished from a softer spring.
inline constexpr double kLongestRise = 0.5;

/// `fit` with a rise over this length after all slips of the recording, which begin and end where `slips`, a fit of all
/// cycles, has them.
BlockFit with_rise_over(double length_m, const FitInput& input, const BlockFit& slips, const BlockFit& fit);

/// The same cycles at the same parameters, their rise after slips that begin and end where `fit` has them.
BlockFit with_rise_after(const BlockFit& fit);

/// The same with a free length of the rise, where there is one.
BlockFit with_free_rise(const BlockFit& fit);

/// The force rises after slips, or has no rise there.
bool rises(const BlockFit& fit);

/// Length of the rise of a fit that has one.
double rise_length_m(const DampedFit& fit);

/// The fit of the same cycles under the same law, its rise settled: its length, and the slips that it comes after.
/// Empty where the data do not sample it. Without a rise `fit` as it is.
std::optional<DampedFit> settle_rise(const FitInput& input, std::optional<DampedFit> fit);

/// Returns a solution with its uncertainty, its rise settled. The result is empty where the data do not distinguish the
/// parameters or do not sample the rise.
std::optional<DampedFit> finish_settled(const FitInput& input, DampedFit fit);

}  // namespace slipfit::fit
