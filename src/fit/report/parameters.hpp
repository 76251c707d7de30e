#pragma once

#include "fit/selection/tiers.hpp"
#include "slipfit/fit/fit.hpp"

namespace slipfit::fit {

/// Turns the block fits into named SI parameters with interval and status, their correlation, and the model estimate.
void report_parameters(const Recording& recording, const TierFits& fits, const Resolution& resolution,
                       FitResult& result);

}  // namespace slipfit::fit
