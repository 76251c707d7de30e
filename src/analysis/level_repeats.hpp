#pragma once

#include <optional>
#include <span>

#include "slipfit/analysis.hpp"

namespace slipfit {

/// Does the force level of the slips repeat over the path (docs/accuracy.md)? `level_repeats`: the path from one
/// repetition to the next, in m. Beyond chance only where neither white scatter of the levels nor a random walk makes
/// such a sine. Empty below thresholds::kFewestOfWave slips.
std::optional<ShortTest> test_level_repeats(std::span<const Cycle> cycles, double speed_m_per_s);

}  // namespace slipfit
