#pragma once

#include "signals.hpp"
#include "slipfit/pipeline.hpp"

namespace slipfit {

/// Frequency from the mean interval between slips, in Hz; empty below 3 slips. The first slip starts from rest and is
/// left out, and so are intervals across a gap of the recording.
Estimate count_frequency(const Recording& recording, const Segmentation& segmentation);

/// Both frequencies and the one to quote: harmonic least squares where the cycles are regular, counting where they
/// scatter. Where a fit shows stick-slip: the cycles of the fit (fitted_frequency.hpp), harmonic least squares where
/// they are regular and it is the sharper. Quoted only where there is a repetition: a count of noise is no frequency,
/// one of what may be hum only where the spectrum shows it too; where the two differ the interval holds both.
FrequencyReport report_frequency(const Recording& recording, const Signals& signals, Verdict verdict,
                                 const FitResult* fit);

CycleStatistics summarise_cycles(const Recording& recording, const Segmentation& segmentation, const FitResult* fit);

/// Spacing V/f and impulse rate from the quoted frequency; uncertainty of the speed included where it is given.
void add_measured_spacing(const Recording& recording, const FrequencyReport& frequency, const CycleStatistics& cycles,
                          Derived& derived);

Warnings collect_warnings(const Recording& recording, const Analysis& analysis);

}  // namespace slipfit
