#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace slipfit::signal {

/// First sample of each run of equal values, where a logger reads its converter more often than that has a new value:
/// runs are (nearly) equally long, and from run to run the value changes by several steps. Empty where values repeat
/// by chance or by rounding, or hardly at all.
std::vector<std::size_t> first_of_repeats(std::span<const double> force);

}  // namespace slipfit::signal
