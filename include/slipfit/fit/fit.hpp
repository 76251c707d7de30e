#pragma once

#include <optional>

#include "slipfit/core/recording.hpp"
#include "slipfit/fit/options.hpp"
#include "slipfit/fit/result.hpp"
#include "slipfit/signal/cycles.hpp"
#include "slipfit/signal/quality.hpp"

namespace slipfit {

/// Fits the tiers that one recording can show to the cycles and chooses one. The result is empty if fewer than 3 cycles
/// can be fitted or no search finds a solution.
std::optional<FitResult> fit_recording(const Recording& recording, const Quality& quality,
                                       const Segmentation& segmentation, const FitOptions& options = {});

}  // namespace slipfit
