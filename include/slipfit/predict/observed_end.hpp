#pragma once

#include <optional>

#include "slipfit/core/estimate.hpp"

namespace slipfit {

/// The range of speeds in which stick-slip ends, as the recordings of a sweep show it.
struct ObservedEnd {
  std::optional<double> sticks_m_per_s;  ///< fastest run with stick-slip
  std::optional<double> slides_m_per_s;  ///< slowest run without it that is faster than all with it
};

/// Returns the speed at which stick-slip ends (m/s), by a fit and by the recordings: the interval of the fit is
/// restricted to the speeds between the fastest recording that sticks and the slowest faster one that does not; these
/// speeds replace it if the fit gives no interval or one outside them.
Estimate with_observed_end(const Estimate& by_fit, const ObservedEnd& observed);

}  // namespace slipfit
