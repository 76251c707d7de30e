#pragma once

#include "fit/problem/block_fit.hpp"
#include "slipfit/signal/cycles.hpp"
#include "slipfit/signal/quality.hpp"

namespace slipfit::fit {

/// Returns all scales but the span of time, which the cycles of the fit give.
Scales scales_of(const Recording& recording, const Quality& quality, const Segmentation& segmentation);

/// Median slope of the rises over the speed, N/m (or 1/m); 0 where no rise has two samples in its middle.
double stiffness_of(const Recording& recording, const Segmentation& segmentation);

/// Fills `fit.parameters` for the given shared ones from peaks, troughs and middles of the slips.
void set_start(BlockFit& fit, const Segmentation& segmentation, const Coordinates& start);

}  // namespace slipfit::fit
