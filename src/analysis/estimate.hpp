#pragma once

#include <optional>

#include "analysis/detect.hpp"
#include "analysis/measured_drive.hpp"
#include "slipfit/fit/fit.hpp"

namespace slipfit {

/// Repetition frequency and fit of the stretch that slides, with the slips that both rest on.
struct Estimates {
  Signals signals;
  std::optional<FitResult> fit;        ///< empty: not asked for, or no cycles to fit
  std::optional<SteadyDrive> drive{};  ///< where the measured motion of the drive was taken off before the fit
  double frequency_s = 0.0;            ///< seconds that the spectrum took
  double fit_s = 0.0;                  ///< seconds that the fit took
};

/// Returns the share of the cycles offered to a fit that it uses; 1 where none was offered.
double used_share(const FitResult& fit);

/// Returns whether the fit uses less than half of the cycles that it was offered: it says nothing of the slips then.
bool leaves_out_most(const FitResult& fit);

/// The spectrum alone.
Estimates estimate_frequency(const Detected& detected);

/// Computes spectrum and fit in parallel if two threads are available. If a line of the mains may have concealed
/// slips or passed for them, slips and fit once more without the mains; the clearly better fit is kept.
Estimates estimate(const Detected& detected, const FitOptions& options);

/// Returns true if a line of the mains is significant and may move turning points, or the slips counted may be its
/// swings.
bool may_be_hum(const Signals& signals);

}  // namespace slipfit
