#pragma once

#include <cstddef>
#include <vector>

#include "fit/problem/block_fit.hpp"
#include "slipfit/core/recording.hpp"

namespace slipfit::fit {

/// Adds `factor` times the fitted interference to those of the values at the samples [begin, end) that are not 0.
void add_hum(const Recording& recording, const BlockFit& fit, std::size_t begin, std::size_t end, double factor,
             std::vector<double>& values);

/// The fitted lines, and the recording without them, for cycles that are cut anew.
HumLines hum_of(const Recording& recording, const BlockFit& fit);

}  // namespace slipfit::fit
