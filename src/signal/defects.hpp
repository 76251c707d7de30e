#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "slipfit/core/recording.hpp"

namespace slipfit::signal {

/// Returns the first sample of each run of equal values if a logger reads its converter more often than that has a new
/// value: from run to run the value changes by several steps. Empty if values repeat by rounding, or hardly at all.
std::vector<std::size_t> first_of_repeats(std::span<const double> force);

/// Returns true if the clock has a gap between these two samples: samples are missing, or a stroke ends.
bool has_gap(const Recording& recording, std::size_t first, std::size_t last);

/// Returns the values with the missing ones interpolated linearly; those at an end are the nearest known value, and all
/// are 0 where none is known. `missing` may be empty: none.
std::vector<double> bridged(std::span<const double> values, const std::vector<bool>& missing);

}  // namespace slipfit::signal
