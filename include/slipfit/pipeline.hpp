#pragma once

#include "slipfit/analysis.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/fit/fit.hpp"

namespace slipfit {

/// Frequency, cycles and kind of motion; no model fit.
Analysis analyze(const Recording& recording);

/// `analyze`, then the fit and what follows from it at the recording's own speed.
Analysis analyze_and_fit(const Recording& recording, const FitOptions& options = {});

}  // namespace slipfit
