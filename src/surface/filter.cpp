#include "surface/filter.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace slipfit::surface {

std::vector<double> gaussian_mean(std::span<const double> heights, double cutoff) {
  // exp(-pi (x / (alpha cutoff))^2) with alpha = sqrt(ln 2 / pi): ISO 16610-21, section 4.
  constexpr double scale = std::numbers::pi * std::numbers::pi / std::numbers::ln2;
  const auto reach = static_cast<std::size_t>(std::ceil(cutoff));
  std::vector<double> weight(reach + 1);
  for (std::size_t k = 0; k < weight.size(); ++k) {
    const double place = static_cast<double>(k) / cutoff;
    weight[k] = std::exp(-scale * place * place);
  }
  const std::size_t count = heights.size();
  const auto at_end = [&](std::size_t i) {
    double sum = 0.0;
    double used = 0.0;
    for (std::size_t j = i - std::min(i, reach); j < std::min(count, i + reach + 1); ++j) {
      const double w = weight[i > j ? i - j : j - i];
      sum += w * heights[j];
      used += w;
    }
    return sum / used;
  };
  const std::size_t first = std::min(reach, count);
  const std::size_t last = std::max(first, count - first);
  std::vector<double> mean(count);
  for (std::size_t i = 0; i < first; ++i) mean[i] = at_end(i);
  for (std::size_t i = last; i < count; ++i) mean[i] = at_end(i);
  // By weight first and place second: the inner loop has no branches.
  double weights = weight[0];
  for (std::size_t k = 1; k <= reach; ++k) weights += 2.0 * weight[k];
  for (std::size_t i = first; i < last; ++i) mean[i] = weight[0] / weights * heights[i];
  for (std::size_t k = 1; k <= reach; ++k) {
    const double share = weight[k] / weights;
    for (std::size_t i = first; i < last; ++i) mean[i] += share * (heights[i - k] + heights[i + k]);
  }
  return mean;
}

std::vector<double> block_means(std::span<const double> heights, std::size_t block) {
  std::vector<double> means(heights.size() / block);
  for (std::size_t j = 0; j < means.size(); ++j) {
    double sum = 0.0;
    for (std::size_t k = 0; k < block; ++k) sum += heights[j * block + k];
    means[j] = sum / static_cast<double>(block);
  }
  return means;
}

std::vector<double> waviness(std::span<const double> heights, double cutoff) {
  const auto block = std::max<std::size_t>(1, static_cast<std::size_t>(cutoff / 64.0));
  const std::vector<double> coarse = gaussian_mean(block_means(heights, block), cutoff / static_cast<double>(block));
  std::vector<double> mean(heights.size());
  const auto last = static_cast<double>(coarse.size() - 1);
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double place = (static_cast<double>(i) + 0.5) / static_cast<double>(block) - 0.5;
    const double left = std::clamp(std::floor(place), 0.0, std::max(0.0, last - 1.0));
    const double share = last > 0.0 ? place - left : 0.0;
    const auto at = static_cast<std::size_t>(left);
    mean[i] = coarse[at] + share * (coarse[std::min(at + 1, coarse.size() - 1)] - coarse[at]);
  }
  return mean;
}

std::vector<double> without_form(std::span<const double> heights) {
  // Legendre polynomials on the samples' own places are orthogonal up to terms of 1/n; a second pass takes these.
  std::vector<double> rest(heights.begin(), heights.end());
  const auto n = static_cast<double>(rest.size());
  for (int pass = 0; pass < 3; ++pass) {
    for (int order = 0; order < 3; ++order) {
      const auto shape = [&](std::size_t i) {
        const double t = (2.0 * static_cast<double>(i) + 1.0) / n - 1.0;
        return order == 0 ? 1.0 : order == 1 ? t : 1.5 * t * t - 0.5;
      };
      double sum = 0.0;
      double norm = 0.0;
      for (std::size_t i = 0; i < rest.size(); ++i) {
        sum += shape(i) * rest[i];
        norm += shape(i) * shape(i);
      }
      for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= sum / norm * shape(i);
    }
  }
  return rest;
}

}  // namespace slipfit::surface
