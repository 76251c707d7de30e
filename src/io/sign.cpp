#include "io/sign.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

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

std::vector<double> thinned(std::span<const double> values) {
  const std::size_t stride = std::max<std::size_t>(1, values.size() / kLevelSamples);
  std::vector<double> kept;
  for (std::size_t i = 0; i < values.size(); i += stride) {
    if (std::isfinite(values[i])) kept.push_back(values[i]);
  }
  return kept;
}

double level_90(std::span<const double> force) {
  std::vector<double> sizes = thinned(force);
  for (double& size : sizes) size = std::abs(size);
  return quantile_of(std::move(sizes), 0.9);
}

/// Returns the parts in which the force is alternately on either side of the middle, each from the first to the last
/// sample beyond the threshold.
std::vector<Stroke> sides_of(std::span<const double> force, double middle, double threshold) {
  std::vector<Stroke> sides;
  for (std::size_t i = 0; i < force.size(); ++i) {
    const double off = force[i] - middle;
    if (!(std::abs(off) > threshold)) continue;
    const bool is_positive = off > 0.0;
    if (sides.empty() || sides.back().is_positive != is_positive) sides.push_back({{i, i}, is_positive});
    sides.back().end = i + 1;
  }
  return sides;
}

/// Cuts off the ends in which the drive turns and takes up the play, and the force rises to its level or falls from it.
/// The rise from zero to the median of sliding is continued to the highest level at its own mean rate, and a quarter is
/// added, as it bends near sliding; a twentieth of the stroke goes at least.
Stroke without_ends(Stroke stroke, std::span<const double> force) {
  constexpr double kReserve = 1.25;
  constexpr double kLeast = 0.05;
  constexpr double kSliding = 0.5;  // of the highest level: below it the force turns, or the play is taken up
  const auto part = stroke.of(force);
  const double sign = stroke.is_positive ? 1.0 : -1.0;
  std::vector<double> forces;
  for (const double f : part) forces.push_back(sign * f);
  const double highest = quantile_of(forces, 0.95);
  std::vector<double> sliding = forces;
  std::erase_if(sliding, [&](double f) { return !(f > kSliding * highest); });
  const double level = quantile_of(std::move(sliding), 0.5);
  const auto end_length = [&](auto first, auto last) {
    const auto reached = std::find_if(first, last, [level](double f) { return f >= level; });
    auto risen = reached;
    while (risen != first && *std::prev(risen) > 0.0) --risen;  // before it lie the other side and the play
    const double rise = reached == last ? 0.0 : level - *risen;
    const auto samples = static_cast<double>(reached - risen);
    const double whole = rise > 0.0 ? samples * (highest - *risen) / rise : samples;
    return static_cast<std::size_t>(risen - first) +
           static_cast<std::size_t>(std::ceil(std::max(kReserve * whole, kLeast * static_cast<double>(forces.size()))));
  };
  const std::size_t front = end_length(forces.begin(), forces.end());
  const std::size_t back = end_length(forces.rbegin(), forces.rend());
  const bool is_left = 3 * (front + back) < 2 * stroke.size();
  const SampleRange kept{stroke.begin + (is_left ? front : 0), is_left ? stroke.end - back : stroke.begin};
  return {kept, stroke.is_positive};
}

/// Returns the indices at which the values turn by more than the hysteresis.
std::vector<std::size_t> turns_of(std::span<const double> values, double hysteresis) {
  std::vector<std::size_t> turns;
  std::size_t extreme = 0;
  double direction = 0.0;  // unknown until the values have moved by the hysteresis
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double moved = values[i] - values[extreme];
    if (direction == 0.0 && std::abs(moved) > hysteresis) direction = moved > 0.0 ? 1.0 : -1.0;
    if (direction * moved < -hysteresis) {
      turns.push_back(extreme);
      direction = -direction;
      extreme = i;
    } else if (direction * moved > 0.0) {
      extreme = i;
    }
  }
  return turns;
}

/// The strokes of a displacement that turns; of each the side of the middle on which most of its forces lie. None where
/// the force does not change its side with the displacement, as where that is the deflection of a spring.
std::vector<Stroke> strokes_by_displacement(const Motion& motion) {
  constexpr double kHysteresis = 0.1;  // of the range
  constexpr double kAlternating = 0.8;
  if (motion.displacement.empty()) return {};
  const std::vector<double> places = thinned(motion.displacement);
  const double range = quantile_of(places, 1.0) - quantile_of(places, 0.0);
  std::vector<std::size_t> ends = turns_of(motion.displacement, kHysteresis * range);
  if (ends.size() < kSmallestTurns) return {};
  ends.insert(ends.begin(), 0);
  ends.push_back(motion.force.size());
  const std::vector<double> forces = thinned(motion.force);
  const double middle = 0.5 * (quantile_of(forces, 0.05) + quantile_of(forces, 0.95));
  std::vector<Stroke> strokes;
  std::size_t alternating = 0;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    if (ends[i + 1] < ends[i] + kShortestStroke) continue;
    Stroke stroke{{ends[i], ends[i + 1]}, true};
    stroke.is_positive = quantile_of(thinned(stroke.of(motion.force)), 0.5) > middle;
    alternating += !strokes.empty() && strokes.back().is_positive != stroke.is_positive ? 1U : 0U;
    strokes.push_back(stroke);
  }
  const bool is_one_way = static_cast<double>(alternating) < kAlternating * (static_cast<double>(strokes.size()) - 1.0);
  return is_one_way || strokes.size() <= kSmallestTurns ? std::vector<Stroke>{} : strokes;
}

std::vector<Stroke> long_enough(std::vector<Stroke> strokes, std::size_t samples) {
  const bool are_strokes = strokes.size() > kSmallestTurns && samples >= kShortestStroke * strokes.size();
  return are_strokes ? std::move(strokes) : std::vector<Stroke>{};
}

std::vector<Stroke> cut(std::vector<Stroke> strokes, std::span<const double> force) {
  for (Stroke& stroke : strokes) stroke = without_ends(stroke, force);
  return strokes;
}

/// Median over the strokes of one side of how far the middle 80 % of a stroke's forces spread.
double spread_of_side(const std::vector<Stroke>& strokes, std::span<const double> force, bool is_positive) {
  std::vector<double> spreads;
  for (const Stroke& stroke : strokes) {
    if (stroke.is_positive != is_positive || stroke.size() == 0) continue;
    const std::vector<double> forces = thinned(stroke.of(force));
    spreads.push_back(quantile_of(forces, 0.9) - quantile_of(forces, 0.1));
  }
  return quantile_of(std::move(spreads), 0.5);
}

/// Forces of both directions scatter alike; those at rest do not scatter as those of sliding.
bool are_sides_alike(const std::vector<Stroke>& strokes, std::span<const double> force) {
  constexpr double kAlike = 5.0;
  constexpr double kSmall = 0.1;  // of the level: both sides are smooth
  const double positive = spread_of_side(strokes, force, true);
  const double negative = spread_of_side(strokes, force, false);
  return std::max(positive, negative) <= kAlike * std::min(positive, negative) + kSmall * level_90(force);
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

std::vector<Stroke> find_strokes(const Motion& motion) {
  const std::span<const double> force = motion.force;
  const auto samples = static_cast<double>(force.size());
  const auto negative = static_cast<double>(count_negative(force));
  if (std::min(negative, samples - negative) < kLeastOfEitherSign * samples) return {};
  if (auto strokes = strokes_by_displacement(motion); !strokes.empty()) return cut(std::move(strokes), force);
  const double near = kNear * level_90(force);
  const auto near_zero = std::ranges::count_if(force, [&](double f) { return std::abs(f) < near; });
  if (static_cast<double>(near_zero) > kMostNear * samples) return {};
  auto strokes = cut(long_enough(sides_of(force, 0.0, near), force.size()), force);
  return are_sides_alike(strokes, force) ? strokes : std::vector<Stroke>{};
}

std::vector<Stroke> take_strokes(const Motion& motion) {
  constexpr double kReversal = 0.5;  // of half the range: slips that nearly reach zero do not turn the force
  constexpr double kOtherSign = 0.1;
  if (auto strokes = strokes_by_displacement(motion); !strokes.empty()) return cut(std::move(strokes), motion.force);
  const std::vector<double> forces = thinned(motion.force);
  const double low = quantile_of(forces, 0.05);
  const double high = quantile_of(forces, 0.95);
  if (!(low < 0.0 && high > 0.0) || std::min(-low, high) < kOtherSign * std::max(-low, high)) return {};
  const double middle = 0.5 * (low + high);
  return cut(long_enough(sides_of(motion.force, middle, kReversal * (high - middle)), motion.force.size()),
             motion.force);
}

bool is_reciprocating(const Motion& motion) {
  return !find_strokes(motion).empty();
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
