#pragma once

#include <optional>

#include "fit/selection/fit_input.hpp"
#include "fit/selection/solution.hpp"

namespace slipfit::fit {

/// Of the mean shape of the slips, unit of the force: what rounding to steps of the converter may do to it.
double tolerated_misfit(const Quality& quality);

/// From solved blocks to a fit with its uncertainty: joined ramps where the data agree. Empty where the normal
/// equations are singular: the cycles do not tell the shared parameters apart.
std::optional<DampedFit> with_uncertainty(DampedFit draft, const Quality& quality);

/// With what rounding and misshapen slips, which repeat from cycle to cycle, add to the uncertainty.
std::optional<DampedFit> finish_fit(const FitInput& input, DampedFit fit);

}  // namespace slipfit::fit
