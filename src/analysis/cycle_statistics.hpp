#pragma once

#include "slipfit/analysis.hpp"
#include "slipfit/signal/cycles.hpp"

namespace slipfit {

/// Of the detected slips; times of stick and slip from the cycles of a fit, where there is one.
CycleStatistics summarise_cycles(const Recording& recording, const Segmentation& segmentation, const FitResult* fit);

/// Spacing V/f and impulse rate from the quoted frequency; uncertainty of the speed included where it is given.
Derived with_measured_spacing(Derived derived, const Recording& recording, const FrequencyReport& frequency,
                              const CycleStatistics& cycles);

}  // namespace slipfit
