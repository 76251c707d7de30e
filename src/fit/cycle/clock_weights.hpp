#pragma once

#include <vector>

#include "fit/problem/block_fit.hpp"

namespace slipfit::fit {

/// The cycles of a fit with weights for samples whose time is uncertain: a time off by dt is a force off by F' dt,
/// little in stick and much in slip. The noise comes from the sticks, the error of the times from what the slips have
/// more.
std::vector<CycleData> weigh_by_slope(const BlockFit& fit);

}  // namespace slipfit::fit
