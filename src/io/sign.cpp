#include "io/sign.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace slipfit::reading {
namespace {

/// Sums of the squares and cubes of changes.
struct Moments {
  double count = 0.0, square = 0.0, cube = 0.0;

  [[nodiscard]] double skewness_without(const Moments& part) const {
    const double mean_square = (square - part.square) / (count - part.count);
    const double mean_cube = (cube - part.cube) / (count - part.count);
    return mean_square > 0.0 ? mean_cube / std::pow(mean_square, 1.5) : 0.0;
  }
};

/// The number of parts of the trace in which changes over `width` samples are compared.
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
