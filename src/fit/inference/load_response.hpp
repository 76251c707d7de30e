#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "slipfit/core/recording.hpp"

namespace slipfit::fit {

/// A normal force that follows the tangential force, as that of a holder which bends at fixed depth does.
/// docs/model.md (31)
struct LoadResponse {
  double share = 0.0;           ///< mu dF_n/dF: by this share of its change the force is less apart from friction
  double standard_error = 0.0;  ///< above 0
  double slope = 0.0;           ///< dF_n/dF
};

/// Returns the response of the measured normal force over the recording. `kinetic_force`: about which the slips swing,
/// in N. The result is empty where it was not measured, or where it does not follow the force by more than its error
/// and 1 %.
std::optional<LoadResponse> load_response(const Recording& recording, double kinetic_force, std::size_t cycles);

/// Returns the mean of at least one response, weighted by their errors.
LoadResponse mean_response(const std::vector<LoadResponse>& responses);

}  // namespace slipfit::fit
