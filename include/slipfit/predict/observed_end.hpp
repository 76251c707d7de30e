#pragma once

#include <optional>

#include "slipfit/core/estimate.hpp"

namespace slipfit {

/// What the runs of a sweep show of where stick-slip ends.
struct ObservedEnd {
  std::optional<double> sticks_m_per_s;  ///< fastest run with stick-slip
  std::optional<double> slides_m_per_s;  ///< slowest run without it that is faster than all with it
};

/// Where stick-slip ends (m/s), by a fit and by the runs: the interval of the fit is cut to the speeds between the
/// fastest run that sticks and the slowest beyond it that does not; where the fit tells nothing, or lies outside, it is
/// theirs.
Estimate with_observed_end(const Estimate& by_fit, const ObservedEnd& observed);

}  // namespace slipfit
