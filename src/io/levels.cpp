#include "io/levels.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/quantile.hpp"

namespace slipfit::reading {
namespace {

constexpr std::size_t kBlocksOfColumn = 512;
constexpr double kOff = 0.5;  // of the 90 % level
constexpr double kSteadyWithin = 0.1;
constexpr double kSteadyPart = 0.8;
constexpr double kNormalQuartile = 0.6745;    // of a normal distribution, in standard deviations
constexpr std::size_t kShortestStretch = 20;  // parts of the column

std::vector<double> finite(std::span<const double> values) {
  std::vector<double> kept;
  std::ranges::copy_if(values, std::back_inserter(kept), [](double v) { return std::isfinite(v); });
  return kept;
}

std::size_t block_size(std::size_t samples) {
  return std::max<std::size_t>(1, samples / kBlocksOfColumn);
}

/// 0 where a block holds no number.
std::vector<double> block_medians(std::span<const double> values) {
  const std::size_t size = block_size(values.size());
  std::vector<double> medians;
  for (std::size_t begin = 0; begin < values.size(); begin += size) {
    const auto block = finite(values.subspan(begin, std::min(size, values.size() - begin)));
    medians.push_back(block.empty() ? 0.0 : quantile_of(block, 0.5));
  }
  return medians;
}

/// Returns true if the halves differ by more than the bound.
bool drifts(std::span<const double> blocks, double bound) {
  const std::size_t half = blocks.size() / 2;
  return half > 0 && std::abs(mean_of(blocks.first(half)) - mean_of(blocks.last(half))) > bound;
}

}  // namespace

std::optional<Level> level_of(std::span<const double> values) {
  auto on = finite(values);
  if (on.empty()) return std::nullopt;
  const double threshold = kOff * quantile_of(on, 0.9);
  std::erase_if(on, [&](double v) { return !(v > threshold); });
  if (on.empty()) return std::nullopt;
  Level level{quantile_of(on, 0.5), 0.0, false};
  for (double& v : on) v = std::abs(v - level.value);
  level.standard_deviation = quantile_of(on, 0.5) / kNormalQuartile;
  auto blocks = block_medians(values);
  std::erase_if(blocks, [&](double v) { return !(v > threshold); });
  const auto near =
      std::ranges::count_if(blocks, [&](double v) { return std::abs(v - level.value) <= kSteadyWithin * level.value; });
  level.is_steady = static_cast<double>(near) >= kSteadyPart * static_cast<double>(blocks.size());
  return level;
}

std::vector<double> block_speeds_m_per_s(std::span<const double> time_s, std::span<const double> displacement_m,
                                         std::size_t blocks) {
  const std::size_t step = std::max<std::size_t>(1, time_s.size() / blocks);
  std::vector<double> speeds;
  for (std::size_t i = step; i < time_s.size(); i += step) {
    const double speed = std::abs(displacement_m[i] - displacement_m[i - step]) / (time_s[i] - time_s[i - step]);
    if (std::isfinite(speed)) speeds.push_back(speed);
  }
  return speeds;
}

std::vector<SampleRange> stretches_of_levels(std::span<const double> values, double tolerance) {
  const auto blocks = block_medians(values);
  const std::size_t size = block_size(values.size());
  const double standing = blocks.empty() ? 0.0 : tolerance * *std::ranges::max_element(blocks);
  std::vector<SampleRange> stretches;
  double lowest = HUGE_VAL;
  double highest = 0.0;
  for (std::size_t begin = 0; begin < blocks.size();) {
    std::size_t end = begin;
    double sum = 0.0;
    do {
      sum += blocks[end++];
    } while (end < blocks.size() && std::abs(blocks[end] * static_cast<double>(end - begin) - sum) <= tolerance * sum);
    const double mean = sum / static_cast<double>(end - begin);
    if (mean > standing && (end - begin) * kShortestStretch >= blocks.size()) {
      if (drifts(std::span(blocks).subspan(begin, end - begin), 0.25 * tolerance * mean)) return {};
      stretches.push_back({begin * size, std::min(end * size, values.size())});
      lowest = std::min(lowest, mean);
      highest = std::max(highest, mean);
    }
    begin = end;
  }
  const bool are_levels = stretches.size() > 1 && highest > (1.0 + 2.0 * tolerance) * lowest;
  return are_levels ? stretches : std::vector<SampleRange>{};
}

}  // namespace slipfit::reading
