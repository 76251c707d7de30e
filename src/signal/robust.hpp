#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace slipfit::signal {

/// Upper median; 0 for no values. Takes a copy to sort in.
inline double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace slipfit::signal
