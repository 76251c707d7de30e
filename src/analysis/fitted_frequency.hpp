#pragma once

#include <optional>

#include "slipfit/analysis.hpp"

namespace slipfit {

/// Frequency (Hz) from the cycles of the fit, with an interval that knows why periods scatter: the stick after a slip
/// lasts until the drop of that slip is made good, so that periods of neighbours are correlated, drops are not. Regular
/// cycles: a line through the onsets; scattering ones: their mean period, with the error of the mean drop. Empty below
/// 5 cycles, and where regular slips are not resolved.
std::optional<Estimate> fitted_frequency(const FitResult& fit, const Recording& recording);

}  // namespace slipfit
