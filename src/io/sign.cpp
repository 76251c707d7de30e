#include "io/sign.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/quantile.hpp"

namespace slipfit::reading {
namespace {

// A uniform saw-tooth about zero has 27 % of its samples below 0.3 of its 90 % level, a sine 19 %, white noise 38 %;
// strokes have what the turning takes, a few per cent.
constexpr double kNear = 0.3;
constexpr double kMostNear = 0.12;
constexpr double kLeastOfEitherSign = 0.2;
constexpr std::size_t kSmallestTurns = 2;
constexpr std::size_t kShortestStroke = 8;  // samples: two levels of a coarse converter alternate faster
constexpr std::size_t kLevelSamples = 8192;

double level_90(std::span<const double> force) {
  const std::size_t stride = std::max<std::size_t>(1, force.size() / kLevelSamples);
  std::vector<double> sizes;
  for (std::size_t i = 0; i < force.size(); i += stride) sizes.push_back(std::abs(force[i]));
  return quantile_of(std::move(sizes), 0.9);
}

/// Changes from beyond +threshold to beyond -threshold and back.
std::size_t count_turns(std::span<const double> force, double threshold) {
  std::size_t turns = 0;
  int side = 0;
  for (const double f : force) {
    const int now = f > threshold ? 1 : f < -threshold ? -1 : side;
    if (side != 0 && now != side) ++turns;
    side = now;
  }
  return turns;
}

std::size_t count_negative(std::span<const double> force) {
  return static_cast<std::size_t>(std::count_if(force.begin(), force.end(), [](double f) { return f < 0.0; }));
}

}  // namespace

std::size_t count_strokes(std::span<const double> force) {
  const auto samples = static_cast<double>(force.size());
  const auto negative = static_cast<double>(count_negative(force));
  if (std::min(negative, samples - negative) < kLeastOfEitherSign * samples) return 1;
  const double near = kNear * level_90(force);
  const auto near_zero = std::count_if(force.begin(), force.end(), [&](double f) { return std::abs(f) < near; });
  if (static_cast<double>(near_zero) > kMostNear * samples) return 1;
  const std::size_t turns = count_turns(force, near);
  return turns >= kSmallestTurns && force.size() >= kShortestStroke * (turns + 1) ? turns + 1 : 1;
}

bool is_reciprocating(std::span<const double> force) {
  return count_strokes(force) > 1;
}

bool is_negative_throughout(std::span<const double> force) {
  return 10 * count_negative(force) >= 9 * force.size();
}

}  // namespace slipfit::reading
