#include "surface/roughness.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace slipfit::surface {
namespace {

/// Rz: mean over the sampling lengths of highest peak above lowest valley.
double mean_height(std::span<const double> heights, std::size_t sampling) {
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t begin = 0; begin + sampling <= heights.size(); begin += sampling) {
    const auto [low, high] = std::ranges::minmax_element(heights.subspan(begin, sampling));
    sum += *high - *low;
    count += 1.0;
  }
  return count > 0.0 ? sum / count : 0.0;
}

}  // namespace

double standard_cutoff_m(double element_m) {
  constexpr std::array kSeries_m = {25e-6, 80e-6, 250e-6, 800e-6, 2.5e-3, 8e-3, 25e-3};
  const auto found = std::ranges::find_if(kSeries_m, [&](double c) { return c >= 2.0 * element_m; });
  return found == kSeries_m.end() ? kSeries_m.back() : *found;
}

std::optional<double> mean_element_width(std::span<const double> heights, double sampling) {
  const auto length = static_cast<std::size_t>(std::max(1.0, sampling));
  const double level = 0.1 * mean_height(heights, length);
  if (!(level > 0.0)) return std::nullopt;
  const double shortest = 0.01 * sampling;
  std::vector<double> begins;  // where the profile rises through the mean line into a peak that counts
  bool is_below = false;
  std::size_t crossed = 0;
  for (std::size_t i = 1; i < heights.size(); ++i) {
    if (heights[i - 1] < 0.0 && heights[i] >= 0.0) crossed = i;
    if (heights[i] < -level) is_below = true;
    const bool is_long = begins.empty() || static_cast<double>(crossed) - begins.back() >= shortest;
    if (heights[i] > level && is_below && is_long) {
      begins.push_back(static_cast<double>(crossed));
      is_below = false;
    }
  }
  if (begins.size() < 3) return std::nullopt;
  return (begins.back() - begins.front()) / static_cast<double>(begins.size() - 1);
}

}  // namespace slipfit::surface
