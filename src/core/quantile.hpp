#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

namespace slipfit {

/// The value that a share (0 to 1) of the others does not exceed; 0 for no values. Takes a copy to sort in.
inline double quantile_of(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Of at least one value.
inline double mean_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// The largest of at least one value over the smallest, all above 0.
inline double ratio_of_ends(std::span<const double> values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return *most / *least;
}

/// Upper median; 0 for no values. Takes a copy to sort in.
inline double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Mean and standard deviation of some values.
struct MeanAndSpread {
  double mean = 0.0;
  double sd = 0.0;
  double count = 0.0;
};

/// All 0 where there are no values, sd 0 for one.
inline MeanAndSpread describe(std::span<const double> values) {
  MeanAndSpread result;
  if (values.empty()) return result;
  result.count = static_cast<double>(values.size());
  result.mean = mean_of(values);
  double square = 0.0;
  for (const double value : values) square += (value - result.mean) * (value - result.mean);
  if (values.size() > 1) result.sd = std::sqrt(square / (result.count - 1.0));
  return result;
}

}  // namespace slipfit
