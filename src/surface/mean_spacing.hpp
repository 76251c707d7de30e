#pragma once

#include <optional>
#include <span>

#include "slipfit/core/estimate.hpp"

namespace slipfit::surface {

/// Mean of a series of distances between neighbours, and how well it is known.
struct MeanSpacing {
  double value = 0.0;
  double standard_error = 0.0;  ///< half of the 95 % interval over 1.96
  Interval ci95;
};

/// Distances of neighbouring ridges depend on each other: a ridge found too late makes one longer and the next shorter
/// (correlation down to -1/2), the middle of a ridge moves with the widths of two (up to +1/2). The mean is that of a
/// normal series with such a correlation of neighbours, averaged over what the data say of it (flat prior for mean and
/// log of the scatter: mixture of t distributions). Empty: fewer than 4 distances.
std::optional<MeanSpacing> mean_spacing(std::span<const double> distances);

}  // namespace slipfit::surface
