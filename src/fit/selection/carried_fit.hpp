#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "fit/problem/block_fit.hpp"
#include "fit/selection/solution.hpp"

namespace slipfit::fit {

/// Takes the solution of other fits of the same slips, of a neighbour where one is not among them.
void carry_over(const BlockFit& from, BlockFit& to);

/// The fit on the cycles of another one, above its own level, its rise after the slips that it has there.
BlockFit carried_to(const std::shared_ptr<const CycleSet>& set, const BlockFit& from);

/// The fit with a time of the sensor as one parameter more.
BlockFit with_free_time(const BlockFit& fit, FreeTime time);

double sum_of_squares(const BlockFit& fit);
std::size_t residuals_in(const BlockFit& fit);

/// Returns whether every cycle has a slip. A search that ran to the longest slip distance may end past it.
bool has_slips(const BlockFit& fit);

/// Returns by how much the AICc of `rich`, a fit with one parameter more, is lower than that of `poor` on the same
/// samples.
double gain_on_same_samples(const DampedFit& rich, const DampedFit& poor);

}  // namespace slipfit::fit
