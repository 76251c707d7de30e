#pragma once

#include <cstddef>
#include <vector>

#include "fit/selection/outliers.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/signal/quality.hpp"

namespace slipfit::fit {

/// The samples of either list; both are in ascending order, and so is the result.
std::vector<std::size_t> united(const std::vector<std::size_t>& first, const std::vector<std::size_t>& second);

/// Returns the samples that no model should be asked to explain: impulses, and those at or past a level where the
/// sensor saturates; in ascending order.
std::vector<std::size_t> initial_exclusions(const Recording& recording, const Quality& quality);

/// Samples whose model lies where the sensor saturates: keeping those that noise has left below the ceiling, and only
/// those, would pull the fit down. `noise`: rms, unit of the force.
std::vector<std::size_t> beyond_clip(const Recording& recording, const Quality& quality, const Residuals& residuals,
                                     double noise);

}  // namespace slipfit::fit
