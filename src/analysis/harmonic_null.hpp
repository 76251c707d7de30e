#pragma once

#include <optional>

#include "slipfit/core/recording.hpp"
#include "slipfit/signal/cycles.hpp"

namespace slipfit {

/// Root mean square of what three harmonics of the cycles' own frequency, on a straight level, leave of a few cycles at
/// a time, in the unit of the force column: the null model that stick-slip has to beat. Empty below 6 slips.
std::optional<double> harmonic_residual_rms(const Recording& recording, const Segmentation& segmentation);

}  // namespace slipfit
