#pragma once

#include "fit/report/findings.hpp"
#include "fit/selection/tiers.hpp"

namespace slipfit::fit {

/// Of one recording: the best fit with zeta >= 0, and what it is uncertain by.
Findings findings_of(const Recording& recording, const TierFits& fits, const Resolution& resolution);

}  // namespace slipfit::fit
