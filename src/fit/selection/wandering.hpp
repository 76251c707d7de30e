#pragma once

#include "fit/problem/block_fit.hpp"

namespace slipfit::fit {

/// Whether a level of its own in every cycle explains more than chance would beyond a polynomial of time: two fits of
/// the same cycles.
bool level_wanders(const BlockFit& wandering, const BlockFit& polynomial, const Held& held);

}  // namespace slipfit::fit
