#pragma once

#include "fit/report/findings.hpp"
#include "fit/selection/tiers.hpp"

namespace slipfit::fit {

/// Of one recording: the best fit with zeta >= 0, and what it is uncertain by. `residual`: of the chosen tier.
Findings findings_of(const Recording& recording, const TierFits& fits, const Resolution& resolution,
                     const Residual& residual);

}  // namespace slipfit::fit
