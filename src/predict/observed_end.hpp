#pragma once

#include "slipfit/predict/derived.hpp"

namespace slipfit::predict {

/// Where stick-slip ends, by the fit and by what the runs show: an interval of the fit is cut to the speeds between the
/// fastest run that sticks and the slowest beyond it that does not; where the fit tells nothing, or lies beyond them, it
/// is theirs.
Estimate with_observed_end(const Estimate& by_fit, const ObservedEnd& observed);

}  // namespace slipfit::predict
