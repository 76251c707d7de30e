#pragma once

#include "fit/inference/level_trend.hpp"
#include "fit/report/findings.hpp"

namespace slipfit::fit {

/// Adds what a trend of the level means for k and for absolute forces, where it changes them by more than their errors:
/// notes, and a warning.
void state_trend(const TrendFindings& trend, const Conditions& conditions, Findings& findings);

}  // namespace slipfit::fit
