#pragma once

#include <cstddef>
#include <vector>

#include "fit/problem/block_fit.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/signal/quality.hpp"

namespace slipfit::fit {

/// Says which part of a cycle a sample is in. None: the sample is outside the fitted cycles, or excluded.
enum class CyclePart : unsigned char { None, Stick, Slip };

/// Data minus model (hum included in the model) at every sample of the recording; 0 where the part is None.
struct Residuals {
  std::vector<double> value;
  std::vector<CyclePart> part;
};

Residuals residuals_of(const Recording& recording, const BlockFit& fit);

/// Returns the residuals with these samples treated as if they were outside the fitted cycles.
Residuals without(Residuals residuals, const std::vector<std::size_t>& excluded);

/// Samples farther from the fit than 4.5 robust standard deviations, `noise` at least. Sticks and slips have a scale
/// each: a slip that the model follows less well is not cut away sample by sample.
std::vector<std::size_t> find_outliers(const Residuals& residuals, double noise);

/// Slips (indices into the segmentation) whose mean square residual is more than 25 times the median: a missed slip, a
/// burst of impulses.
std::vector<std::size_t> unexplained_slips(const BlockFit& fit);

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
