#pragma once

#include <optional>

#include "slipfit/core/recording.hpp"
#include "slipfit/fit/options.hpp"
#include "slipfit/fit/result.hpp"
#include "slipfit/signal/cycles.hpp"

namespace slipfit::fit {

/// Fit of a recording whose sensor sits at the contact. Its force jumps at both ends of a slip, so that no sum of
/// squares has a smooth minimum; k, F_s - F_k, w_n and zeta follow from four means instead: slope of the ramps, both
/// jumps, duration of the slip. Empty below 3 cycles with both jumps, or where no damping ratio below 0.6 explains
/// them. `options.held` and `options.tier` do not apply: a warning says so.
std::optional<FitResult> fit_contact(const Recording& recording, const Segmentation& segmentation,
                                     const FitOptions& options);

}  // namespace slipfit::fit
