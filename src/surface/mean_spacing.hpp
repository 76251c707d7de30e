#pragma once

#include <optional>
#include <span>

#include "slipfit/core/estimate.hpp"

namespace slipfit::surface {

/// The mean of a series of distances between neighbours, and its uncertainty.
struct MeanSpacing {
  double value = 0.0;
  double standard_error = 0.0;  ///< half of the 95 % interval over kNormalQuantile
  Interval ci95;
  double clock_share = 0.0;  ///< probability that the positions scatter around even marks
};

/// Properties of the marks by the spectrum, if their positions scatter around even ones.
struct Clock {
  double spacing = 0.0;
  double standard_error = 0.0;
};

/// Distances of neighbouring ridges depend on each other: a ridge found too late makes one longer and the next shorter
/// (correlation down to -1/2), the middle of a ridge moves with the widths of two (up to +1/2). The mean is that of a
/// normal series with such a correlation of neighbours, averaged over what the data say of it (mixture of t
/// distributions). Priors are flat in the mean, in the scatter (in its logarithm, few distances that are alike by luck
/// would have too small an interval) and in the correlation, with half of the weight on that of a clock. `miscount` is
/// the standard error that ridges seen double or not at all add. Empty: fewer than 4 distances.
std::optional<MeanSpacing> mean_spacing(std::span<const double> distances, const std::optional<Clock>& clock = {},
                                        double miscount = 0.0);

}  // namespace slipfit::surface
