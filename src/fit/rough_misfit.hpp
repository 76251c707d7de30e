#pragma once

#include <cstddef>
#include <optional>

#include "fit/selection/fit_input.hpp"

namespace slipfit::fit {

/// How badly slips fit before anything is left out of them.
struct RoughMisfit {
  double relative_residual = 0.0;   ///< over the mean onset force
  double onset_force_spread = 0.0;  ///< standard deviation over the cycles, over their mean
  std::size_t cycles = 0;
};

/// Of few slips. Empty where there is no fit.
std::optional<RoughMisfit> rough_misfit(const FitInput& few);

}  // namespace slipfit::fit
