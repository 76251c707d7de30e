#pragma once

#include <cstddef>

#include "core/quantile.hpp"

namespace slipfit::signal {

/// Every so many values are enough for a median: of 40 000 of them it is known to 1 %.
inline std::size_t stride_for(std::size_t count) {
  constexpr std::size_t kEnough = 40000;
  return 1 + count / kEnough;
}

/// From the median of |x| to the standard deviation, normal distribution.
inline constexpr double kMedianToSigma = 1.4826;

using slipfit::median;

}  // namespace slipfit::signal
