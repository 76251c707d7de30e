#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace slipfit::signal {

/// Every so many values are enough for a median: of 40 000 of them it is known to 1 %.
inline std::size_t stride_for(std::size_t count) {
  constexpr std::size_t kEnough = 40000;
  return 1 + count / kEnough;
}

/// From the median of |x| to the standard deviation, normal distribution.
inline constexpr double kMedianToSigma = 1.4826;

/// Upper median; 0 for no values. Takes a copy to sort in.
inline double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace slipfit::signal
