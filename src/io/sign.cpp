#include "io/sign.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/quantile.hpp"

namespace slipfit::reading {
namespace {

// A uniform saw-tooth about zero has 27 % of its samples below 0.3 of its 90 % level, a sine 19 %, white noise 38 %;
// strokes have what the turning takes, a few per cent.
constexpr double kNear = 0.3;
constexpr double kNearAsTold = 0.1;
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

/// From the first to behind the last sample beyond the threshold on either side in turn.
std::vector<Stroke> sides_of(std::span<const double> force, double threshold) {
  std::vector<Stroke> sides;
  for (std::size_t i = 0; i < force.size(); ++i) {
    if (!(std::abs(force[i]) > threshold)) continue;
    const bool is_positive = force[i] > 0.0;
    if (sides.empty() || sides.back().is_positive != is_positive) sides.push_back({{i, i}, is_positive});
    sides.back().end = i + 1;
  }
  return sides;
}

/// The force turns at the rate of the spring: from the rate through zero follows how long it takes from the highest
/// level. A quarter more, as it bends near sliding, and a twentieth of the stroke at least.
Stroke without_ends(Stroke stroke, std::span<const double> force, double samples_through_zero, double threshold) {
  constexpr double kReserve = 1.25;
  constexpr double kLeast = 0.05;
  std::vector<double> sizes;
  for (const double f : stroke.of(force)) sizes.push_back(std::abs(f));
  const double rise = quantile_of(std::move(sizes), 0.95) - threshold;
  const auto length = static_cast<double>(stroke.size());
  const auto ends = static_cast<std::size_t>(
      std::ceil(std::max(kReserve * rise * samples_through_zero / (2.0 * threshold), kLeast * length)));
  const bool is_left = 3 * ends < stroke.size();
  const SampleRange kept{stroke.begin + (is_left ? ends : 0), is_left ? stroke.end - ends : stroke.begin};
  return {kept, stroke.is_positive};
}

std::vector<Stroke> parted(std::span<const double> force, double near) {
  std::vector<Stroke> strokes = sides_of(force, near);
  if (strokes.size() <= kSmallestTurns || force.size() < kShortestStroke * strokes.size()) return {};
  std::vector<double> turns;
  for (std::size_t i = 1; i < strokes.size(); ++i) {
    turns.push_back(static_cast<double>(strokes[i].begin - strokes[i - 1].end + 1));
  }
  const double turn = quantile_of(std::move(turns), 0.5);
  for (Stroke& stroke : strokes) stroke = without_ends(stroke, force, turn, near);
  return strokes;
}

/// Sums of the squares and cubes of changes.
struct Moments {
  double count = 0.0, square = 0.0, cube = 0.0;

  [[nodiscard]] double skewness_without(const Moments& part) const {
    const double mean_square = (square - part.square) / (count - part.count);
    const double mean_cube = (cube - part.cube) / (count - part.count);
    return mean_square > 0.0 ? mean_cube / std::pow(mean_square, 1.5) : 0.0;
  }
};

/// Of the changes over `width` samples, in parts of the trace.
constexpr std::size_t kParts = 16;
std::array<Moments, kParts> moments_of_changes(std::span<const double> force, std::size_t width) {
  std::array<Moments, kParts> parts{};
  for (std::size_t i = 0; i + width < force.size(); ++i) {
    const double change = force[i + width] - force[i];
    Moments& part = parts[i * kParts / force.size()];
    part.count += 1.0;
    part.square += change * change;
    part.cube += change * change * change;
  }
  return parts;
}

std::size_t count_negative(std::span<const double> force) {
  return static_cast<std::size_t>(std::ranges::count_if(force, [](double f) { return f < 0.0; }));
}

}  // namespace

std::vector<Stroke> find_strokes(std::span<const double> force) {
  const auto samples = static_cast<double>(force.size());
  const auto negative = static_cast<double>(count_negative(force));
  if (std::min(negative, samples - negative) < kLeastOfEitherSign * samples) return {};
  const double near = kNear * level_90(force);
  const auto near_zero = std::ranges::count_if(force, [&](double f) { return std::abs(f) < near; });
  if (static_cast<double>(near_zero) > kMostNear * samples) return {};
  return parted(force, near);
}

std::vector<Stroke> take_strokes(std::span<const double> force) {
  return parted(force, kNearAsTold * level_90(force));
}

bool is_reciprocating(std::span<const double> force) {
  return !find_strokes(force).empty();
}

SuddenChanges sudden_changes(std::span<const double> force) {
  constexpr double kSkewness = 0.3;           // -0.3 for cycles near the limit of stick-slip, 0 for waves and noise
  constexpr std::size_t kLeastChanges = 512;  // in the trace, one behind the other: that of noise is below 0.2
  for (std::size_t width = 1; width * kLeastChanges <= force.size(); width *= 2) {
    const std::array<Moments, kParts> parts = moments_of_changes(force, width);
    Moments all;
    for (const Moments& part : parts) {
      all.count += part.count;
      all.square += part.square;
      all.cube += part.cube;
    }
    const auto falls = [&all](const Moments& part) { return all.skewness_without(part) < -kSkewness; };
    const auto rises = [&all](const Moments& part) { return all.skewness_without(part) > kSkewness; };
    if (std::ranges::all_of(parts, falls)) return SuddenChanges::Falls;
    if (std::ranges::all_of(parts, rises)) return SuddenChanges::Rises;
  }
  return SuddenChanges::None;
}

bool is_mostly_negative(std::span<const double> force) {
  return 2 * count_negative(force) > force.size();
}

bool is_negative_throughout(std::span<const double> force) {
  return 10 * count_negative(force) >= 9 * force.size();
}

}  // namespace slipfit::reading
