#pragma once

#include <vector>

#include "fit/selection/solution.hpp"

namespace slipfit::fit {

/// The fit of the fewest terms stays where the data do not pay for more; where they do not rule a fit with more terms
/// out either, its intervals hold what both say. The covariance becomes that of `other`, and nowhere smaller than it
/// was; the way to the values of `other` lengthens one side (moves_to_rivals).
DampedFit widened_by_rival(DampedFit fit, const DampedFit& other);

/// Returns the moves from `blocks`, the reported ones of a fit, to each of its rivals, in the coordinates that both
/// have.
std::vector<Coordinates> moves_to_rivals(const DampedFit& fit, const BlockFit& blocks);

}  // namespace slipfit::fit
