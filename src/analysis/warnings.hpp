#pragma once

#include "slipfit/analysis.hpp"
#include "slipfit/signal/cycles.hpp"

namespace slipfit {

/// Of the reader, the quality, the lines beside the slips, the short tests, the fit, and of what changes on the way.
Warnings collect_warnings(const Recording& recording, const Segmentation& slips, const Analysis& analysis);

}  // namespace slipfit
