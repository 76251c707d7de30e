#pragma once

#include <optional>

#include "slipfit/analysis.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/core/result.hpp"
#include "slipfit/fit/fit.hpp"

namespace slipfit {

/// Why there is nothing to analyse: fewer than 16 samples (too_few_samples), or the same force in all of them
/// (force_constant); empty where there is.
std::optional<Error> missing_data(const Recording& recording);

/// The recording, or that error. An error is passed on.
Result<Recording> with_data(Result<Recording> recording);

/// Frequency, cycles and kind of motion; no model fit.
Analysis analyze(const Recording& recording);

/// `analyze`, then the fit and what follows from it at the recording's own speed.
Analysis analyze_and_fit(const Recording& recording, const FitOptions& options = {});

}  // namespace slipfit
