#pragma once

#include "fit/selection/damped_fit.hpp"
#include "slipfit/fit/options.hpp"
#include "slipfit/fit/result.hpp"

namespace slipfit::fit {

/// fit_recording for a caller who may learn meanwhile that another fit will be kept.
std::optional<FitResult> fit_unless(const GiveUp& give_up, const Recording& recording, const Quality& quality,
                                    const Segmentation& segmentation, const FitOptions& options);

}  // namespace slipfit::fit
