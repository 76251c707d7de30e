#pragma once

#include "fit/problem/block_fit.hpp"

namespace slipfit::fit {

/// Returns whether a level of its own in every cycle explains more than a polynomial of time does, by more than chance
/// explains. The two are fits of the same cycles.
bool level_wanders(const BlockFit& wandering, const BlockFit& polynomial, const Held& held);

}  // namespace slipfit::fit
