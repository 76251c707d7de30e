#pragma once

#include <optional>
#include <vector>

#include "fit/selection/damped_fit.hpp"
#include "fit/selection/tiers.hpp"
#include "slipfit/fit/options.hpp"

namespace slipfit::fit {

/// The fits of one recording, and what was chosen of them.
struct Chosen {
  TierFits fits;
  Resolution resolution;
  std::vector<Candidate> candidates;
  Warnings warnings{};
};

/// Returns the poorest law, seen through the sensor, that explains the recording; empty where it has no cycles to fit.
/// The ring-down of the options, if there is one, adds data of w_n and zeta to the slips where both are of one motion:
/// their mean is held and its errors are in the covariances. Where they are not, a warning says so.
std::optional<Chosen> choose_with_ring_down(const FitInput& input, const FitOptions& options,
                                            const AbortPredicate& should_abort);

}  // namespace slipfit::fit
