#pragma once

#include <vector>

#include "slipfit/fit/fit.hpp"

namespace slipfit::fit {

/// A row for each detected slip, without what a fit adds.
std::vector<Cycle> detected_cycles(const Recording& recording, const Segmentation& segmentation);

}  // namespace slipfit::fit
