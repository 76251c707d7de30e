#pragma once

#include <vector>

#include "slipfit/core/recording.hpp"
#include "slipfit/fit/result.hpp"
#include "slipfit/signal/cycles.hpp"

namespace slipfit::fit {

/// A row for each detected slip, without what a fit adds.
std::vector<Cycle> detected_cycles(const Recording& recording, const Segmentation& segmentation);

}  // namespace slipfit::fit
