#pragma once

#include <optional>

#include "analysis/detect.hpp"
#include "slipfit/fit/fit.hpp"

namespace slipfit {

/// Repetition frequency and fit of the stretch that slides, with the slips that both rest on.
struct Estimates {
  Signals signals;
  std::optional<FitResult> fit;  ///< empty: not asked for, or no cycles to fit
  double frequency_s = 0.0;      ///< seconds that the spectrum took
  double fit_s = 0.0;            ///< seconds that the fit took
};

/// The spectrum alone.
Estimates estimate_frequency(const Detected& detected);

/// Spectrum and fit, beside each other in two threads where there are two. Where a line of the mains may have hidden
/// slips or passed for them, slips and fit once more without the mains; the clearly better fit is kept.
Estimates estimate(const Detected& detected, const FitOptions& options);

/// A line of the mains stands out and may move turning points, or the slips counted may be its swings.
bool may_be_hum(const Signals& signals);

}  // namespace slipfit
