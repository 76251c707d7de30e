#pragma once

#include <functional>

#include "slipfit/fit/options.hpp"
#include "slipfit/fit/result.hpp"

namespace slipfit::fit {

/// fit_recording for a caller who may learn meanwhile that another fit will be kept: asked once, before all of many
/// cycles are fitted, where the model misses much of some of them. True ends the fit, which is then empty.
std::optional<FitResult> fit_unless(const std::function<bool()>& is_other_kept, const Recording& recording,
                                    const Quality& quality, const Segmentation& segmentation,
                                    const FitOptions& options);

}  // namespace slipfit::fit
