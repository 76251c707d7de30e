#pragma once

#include <optional>

#include "fit/selection/solution.hpp"

namespace slipfit::fit {

/// Returns the change that rounding to steps of the converter may make to the mean shape of the slips, in the unit of
/// the force.
double tolerated_misfit(const Quality& quality);

/// Makes a fit with its uncertainty from solved blocks, with joined ramps where the data agree. The result is empty
/// where the normal equations are singular: the cycles do not distinguish the shared parameters.
std::optional<DampedFit> with_uncertainty(DampedFit draft, const Quality& quality);

/// Returns the fit with what rounding and misshapen slips, which repeat from cycle to cycle, add to the uncertainty.
std::optional<DampedFit> finish_fit(const FitInput& input, DampedFit fit);

}  // namespace slipfit::fit
