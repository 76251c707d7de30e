#pragma once

#include <cstddef>

#include "core/quantile.hpp"

namespace slipfit::signal {

/// Returns a stride at which enough values remain for a median: 40 000 of them determine it to 1 %.
inline std::size_t stride_for(std::size_t count) {
  constexpr std::size_t kEnough = 40000;
  return 1 + count / kEnough;
}

/// The ratio of the standard deviation to the median of |x| of a normal distribution.
inline constexpr double kMedianToSigma = 1.4826;

using slipfit::median;

}  // namespace slipfit::signal
