#pragma once

#include "signals.hpp"
#include "slipfit/pipeline.hpp"

namespace slipfit {

/// Both frequencies and the one to quote, which is of slips (or of an oscillation that is the motion): the cycles of a
/// fit that is the model's (fitted_frequency.hpp), or harmonic least squares where they are regular and it is the
/// sharper; without such a fit the count, or harmonic least squares where they agree on regular slips. Steady sliding
/// and what cannot be told quote none. `fit`: empty unless its cycles are the model's.
FrequencyReport report_frequency(const Recording& recording, const Signals& signals, Verdict verdict,
                                 const FitResult* fit);

CycleStatistics summarise_cycles(const Recording& recording, const Segmentation& segmentation, const FitResult* fit);

/// Spacing V/f and impulse rate from the quoted frequency; uncertainty of the speed included where it is given.
void add_measured_spacing(const Recording& recording, const FrequencyReport& frequency, const CycleStatistics& cycles,
                          Derived& derived);

Warnings collect_warnings(const Recording& recording, const Analysis& analysis);

}  // namespace slipfit
