#pragma once

#include <optional>

#include "slipfit/analysis.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/core/result.hpp"
#include "slipfit/fit/fit.hpp"

namespace slipfit {

/// Returns the reason why a recording cannot be analysed: fewer than 16 samples (too_few_samples), or the same force in
/// all of them (force_constant); empty if it can.
std::optional<Error> missing_data(const Recording& recording);

/// Returns the recording if it can be analysed, otherwise the reason of missing_data(). An error is passed on.
Result<Recording> with_data(Result<Recording> recording);

/// Determines frequency, cycles and kind of motion without a model fit.
Analysis analyze(const Recording& recording);

/// Analyses the recording, fits the model, and derives the quantities at the recording's own speed.
Analysis analyze_and_fit(const Recording& recording, const FitOptions& options = {});

}  // namespace slipfit
