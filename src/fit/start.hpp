#pragma once

#include <optional>
#include <vector>

#include "fit/block_fit.hpp"
#include "slipfit/signal/cycles.hpp"
#include "slipfit/signal/quality.hpp"

namespace slipfit::fit {

/// Half period from the 80 % to 20 % falls: a half cosine passes them in acos(-0.6) - acos(0.6) of its pi.
double half_period_of(const Segmentation& segmentation);

/// All but the span of time, which the cycles of the fit give.
Scales scales_of(const Recording& recording, const Quality& quality, const Segmentation& segmentation);

/// Merges centred sums (parallel axis rule): the same as reducing all samples at once.
StickBin merge(const std::vector<StickBin>& bins);

/// How much steeper a ramp begins (after a slip) than it ends (before the next): ln of the ratio of the slopes, with
/// the standard error over cycles. 0 for the model's straight sticks. Empty below 5 cycles with both halves.
struct RampBend {
  double log_ratio = 0.0;
  double standard_error = 0.0;
};
std::optional<RampBend> ramp_bend(const BlockFit& fit);

/// Rate (force a second) at which levels of their own rise from cycle to cycle, 0 where that is chance (3 standard
/// errors) or the level is a polynomial. A sensor that drifts adds it to every ramp, friction that changes does not.
double level_trend(const BlockFit& fit);

/// Median slope of the rises over the speed, N/m (or 1/m); 0 where no rise has two samples in its middle.
double stiffness_of(const Recording& recording, const Segmentation& segmentation);

/// Fills `fit.parameters` for the given shared ones from peaks, troughs and middles of the slips.
void set_start(BlockFit& fit, const Segmentation& segmentation, const Shared& shared);

}  // namespace slipfit::fit
