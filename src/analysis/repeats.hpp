#pragma once

#include <span>
#include <vector>

#include "slipfit/sweep.hpp"

namespace slipfit {

/// Mean and scatter over recordings that are all at one speed; empty where they are not.
std::vector<Repeat> compare_repeats(std::span<const SweepEntry> entries, std::span<const Analysis> analyses);

}  // namespace slipfit
