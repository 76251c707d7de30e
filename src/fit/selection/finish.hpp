#pragma once

#include <optional>

#include "fit/selection/solution.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/signal/cycles.hpp"
#include "slipfit/signal/quality.hpp"

namespace slipfit::fit {

/// From solved blocks to a fit with its uncertainty: joined ramps where the data agree, rounding and misshapen slips
/// allowed for. `half_width_s` as the cycles were cut with. Empty where the normal equations are singular: the cycles
/// do not tell the shared parameters apart.
std::optional<DampedFit> finish_fit(const Recording& recording, const Quality& quality,
                                    const Segmentation& segmentation, double half_width_s, DampedFit draft);

}  // namespace slipfit::fit
