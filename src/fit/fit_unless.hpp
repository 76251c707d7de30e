#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "fit/selection/solution.hpp"
#include "slipfit/fit/options.hpp"
#include "slipfit/fit/result.hpp"

namespace slipfit::fit {

/// fit_recording for a caller who may learn meanwhile that another fit will be kept: asked once, where the model misses
/// much of the cycles, or of some of them before all of many are fitted. True ends the fit, which is then empty.
std::optional<FitResult> fit_unless(const std::function<bool()>& is_other_kept, const Recording& recording,
                                    const Quality& quality, const Segmentation& segmentation,
                                    const FitOptions& options);

/// Holds how badly slips fit before anything is left out of them.
struct RoughMisfit {
  double relative_residual = 0.0;   ///< over the mean onset force
  double onset_force_spread = 0.0;  ///< standard deviation over the cycles, over their mean
  std::size_t cycles = 0;
};

/// Returns the misfit of few slips; it is empty where there is no fit.
std::optional<RoughMisfit> rough_misfit(const FitInput& few);

}  // namespace slipfit::fit
