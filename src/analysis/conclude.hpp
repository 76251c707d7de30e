#pragma once

#include <span>

#include "analysis/classify.hpp"
#include "analysis/detect.hpp"
#include "analysis/estimate.hpp"
#include "slipfit/analysis.hpp"
#include "slipfit/sweep.hpp"

namespace slipfit {

/// Works out everything that follows from slips, spectrum and fit of the stretch that slides: the frequency to quote,
/// statistics of the cycles, coefficients of friction, what is derived from the fit, short tests, contradictions and
/// warnings. These limit the status of the fitted parameters. The fit moves from `estimates` to the analysis.
Analysis conclude(const Detected& detected, Estimates& estimates, Classification classification);

/// Returns the analysis without falls where it is steady sliding, which has no slips. Comparisons of several speeds
/// look at the falls before.
Analysis without_falls(Analysis analysis);

/// Returns the sweep with everything that follows from its recordings, their roles and its fit.
SweepAnalysis conclude_sweep(std::span<const SweepEntry> entries, SweepAnalysis sweep);

}  // namespace slipfit
