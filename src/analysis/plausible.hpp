#pragma once

#include <optional>

#include "slipfit/analysis.hpp"

namespace slipfit {

/// Numbers that no tester has, mostly from a unit that was mistaken: with the factor of 1000 that would mend them.
std::optional<Warning> implausible_units(const Recording& recording, const Analysis& analysis);

}  // namespace slipfit
