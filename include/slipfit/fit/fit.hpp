#pragma once

#include <optional>

#include "slipfit/core/recording.hpp"
#include "slipfit/fit/result.hpp"
#include "slipfit/signal/cycles.hpp"
#include "slipfit/signal/quality.hpp"

namespace slipfit {

struct FitOptions {
  std::optional<Tier> tier{};  ///< empty: chosen by the data
  HeldParameters held{};
  bool curve = false;  ///< fill FitResult::curve (16 bytes a sample)
};

/// Fits every tier to the cycles and chooses. Empty where fewer than 3 cycles can be fitted.
std::optional<FitResult> fit_recording(const Recording& recording, const Quality& quality,
                                       const Segmentation& segmentation, const FitOptions& options = {});

}  // namespace slipfit
