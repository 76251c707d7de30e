#pragma once

#include <optional>

#include "fit/selection/solution.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/fit/parameter.hpp"
#include "slipfit/signal/cycles.hpp"
#include "slipfit/signal/quality.hpp"

namespace slipfit::fit {

/// The fit with one parameter more, the time W over which the instrument averages its samples (docs/model.md section
/// 7), where it is not stated and `plain`, the fit without, shows its sign: rounded slips (DampedFit::rounding).
/// Its covariance holds that of W. Empty where W does not explain all that `plain` misses of the slips, where a sensor
/// of first order explains it as well, and where W cannot be told from the slips behind it.
std::optional<DampedFit> fit_average(const Recording& recording, const Quality& quality,
                                     const Segmentation& segmentation, const HeldParameters& held,
                                     const DampedFit& plain);

}  // namespace slipfit::fit
