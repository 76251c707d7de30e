#pragma once

#include <optional>

#include "fit/selection/solution.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/fit/parameter.hpp"
#include "slipfit/signal/cycles.hpp"
#include "slipfit/signal/quality.hpp"

namespace slipfit::fit {

/// The fit with one parameter more, the time W over which the instrument averages its samples (docs/model.md section
/// 7), where it is not stated and `plain`, the fit without, shows its signs: rounded slips or a negative damping ratio.
/// Its covariance holds that of W. Empty where W does not explain what `plain` misses: the misfit of the slips' mean
/// shape has to fall to half, and W to be three times its error and shorter than the sticks.
std::optional<DampedFit> fit_average(const Recording& recording, const Quality& quality,
                                     const Segmentation& segmentation, const HeldParameters& held,
                                     const DampedFit& plain);

}  // namespace slipfit::fit
