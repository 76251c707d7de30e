#include "signal/defects.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "core/thresholds.hpp"

namespace slipfit::signal {
namespace {

/// The three samples next to the suspected one.
struct Side {
  double median = 0.0;
  double range = 0.0;
};

Side side_of(double a, double b, double c) {
  const double low = std::min({a, b, c});
  const double high = std::max({a, b, c});
  return {std::max(std::min(a, b), std::min(std::max(a, b), c)), high - low};
}

/// Returns true if `width` samples from i on differ from both sides. The variation of the sides themselves is allowed
/// for: the step between them (a slip), and the range within the quieter one (a slope, the crest of a wave with few
/// samples a period).
bool is_prominent(std::span<const double> force, std::size_t i, std::size_t width, double noise_rms) {
  const double* after = force.data() + i + width;
  const Side left = side_of(force[i - 1], force[i - 2], force[i - 3]);
  const Side right = side_of(after[0], after[1], after[2]);
  const double level = 0.5 * (left.median + right.median);
  const double allowed = thresholds::kNoiseSigmas * noise_rms + std::abs(left.median - right.median) +
                         1.5 * std::min(left.range, right.range);
  const double first = force[i] - level;
  const double last = force[i + width - 1] - level;
  return std::min(std::abs(first), std::abs(last)) > allowed && (first > 0.0) == (last > 0.0);
}

}  // namespace

std::vector<bool> find_impulses(std::span<const double> force, double noise_rms) {
  std::vector<std::size_t> found;
  const double least_step = 0.5 * thresholds::kNoiseSigmas * noise_rms;
  for (std::size_t i = 3; i + 4 < force.size(); ++i) {
    constexpr std::size_t kBlock = 16;  // nearly everywhere nothing begins in a whole block
    using Block = Eigen::Map<const Eigen::Array<double, kBlock, 1>>;
    while (i + kBlock + 4 < force.size() && (Block(&force[i]) - Block(&force[i - 1])).abs().maxCoeff() <= least_step) {
      i += kBlock;
    }
    if (std::abs(force[i] - force[i - 1]) <= least_step) continue;
    std::size_t width = 0;
    if (is_prominent(force, i, 1, noise_rms)) {
      width = 1;
    } else if (i + 5 < force.size() && is_prominent(force, i, 2, noise_rms)) {
      width = 2;
    }
    for (std::size_t k = 0; k < width; ++k) found.push_back(i + k);
    if (width > 0) i += width - 1;
  }
  std::vector<bool> mask;
  if (found.empty()) return mask;
  mask.resize(force.size(), false);
  for (const std::size_t i : found) mask[i] = true;
  return mask;
}

}  // namespace slipfit::signal
