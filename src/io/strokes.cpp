#include "io/strokes.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/statistics.hpp"

namespace slipfit::reading {
namespace {

// A uniform saw-tooth about zero has 27 % of its samples below 0.3 of its 90 % level, a sine 19 %, white noise 38 %;
// strokes have what the turning takes, a few per cent.
constexpr double kNear = 0.3;
constexpr double kMostNear = 0.12;
constexpr double kLeastOfEitherSign = 0.2;
constexpr std::size_t kSmallestTurns = 2;
constexpr std::size_t kFewestByLevel = 3;  // a step of the level is no test of two strokes
constexpr std::size_t kFewestBySlips = 2;
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

/// The forces of a stroke in its own direction, above the middle.
std::vector<double> own_forces(const Stroke& stroke, std::span<const double> force, double middle) {
  std::vector<double> forces;
  forces.reserve(stroke.size());
  for (const double f : stroke.of(force)) forces.push_back(stroke.is_positive ? f - middle : middle - f);
  return forces;
}

/// A slip between two sticks of one stroke.
struct InnerSlip {
  std::size_t trough = 0;
  double rise_over_fall = 0.0;  ///< time from the trough to the next peak over that of the fall
};

/// The slips inside a stroke with the given forces in its own direction. The highest quarter of these covers about half
/// of a slip where the body slides for most of the stroke, and a whole one where it does so for a third.
std::vector<InnerSlip> inner_slips(const std::vector<double>& forces) {
  constexpr double kHysteresis = 0.5;
  const std::vector<double> few = thinned(forces);
  const double upper = quantile_of(few, 0.99) - quantile_of(few, 0.75);
  const std::vector<std::size_t> turns = turns_of(forces, kHysteresis * upper);
  std::vector<InnerSlip> slips;
  for (std::size_t i = 1; i + 1 < turns.size(); ++i) {
    const bool is_trough = forces[turns[i]] < forces[turns[i - 1]] && forces[turns[i]] > 0.0;
    if (!is_trough) continue;
    slips.push_back(
        {turns[i], static_cast<double>(turns[i + 1] - turns[i]) / static_cast<double>(turns[i] - turns[i - 1])});
  }
  return slips;
}

/// A stroke with slips from where its force first reaches the lowest trough between two slips to the last peak of its
/// force, a twentieth of it less at either end at least: before and after it the drive turns.
Stroke between_reversals(const Stroke& stroke, const std::vector<double>& forces, const std::vector<InnerSlip>& slips) {
  constexpr double kLeast = 0.05;
  const auto least = static_cast<std::size_t>(std::ceil(kLeast * static_cast<double>(forces.size())));
  double lowest = forces[slips.front().trough];
  for (const InnerSlip& slip : slips) lowest = std::min(lowest, forces[slip.trough]);
  const auto reached = std::ranges::find_if(forces, [lowest](double f) { return f >= lowest; });
  const auto last = std::max_element(forces.begin() + static_cast<std::ptrdiff_t>(slips.back().trough), forces.end());
  const std::size_t begin = std::max(least, static_cast<std::size_t>(reached - forces.begin()));
  const std::size_t end = std::min(forces.size() - least, static_cast<std::size_t>(last - forces.begin()));
  return {{stroke.begin + begin, stroke.begin + std::max(begin, end)}, stroke.is_positive};
}

/// Cuts off the ends in which the drive turns and takes up the play, and the force rises to its level or falls from it.
/// The rise from zero to the median of sliding is continued to the highest level at its own mean rate, and a quarter is
/// added, as it bends near sliding; a twentieth of the stroke goes at least.
Stroke without_ends(const Stroke& stroke, std::span<const double> force, double middle) {
  constexpr double kReserve = 1.25;
  constexpr double kLeast = 0.05;
  constexpr double kSliding = 0.5;  // of the highest level: below it the force turns, or the play is taken up
  const std::vector<double> forces = own_forces(stroke, force, middle);
  if (const std::vector<InnerSlip> slips = inner_slips(forces); !slips.empty()) {
    return between_reversals(stroke, forces, slips);
  }
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

std::vector<Stroke> long_enough(std::vector<Stroke> strokes, std::size_t samples, std::size_t fewest) {
  const bool are_strokes = strokes.size() >= fewest && samples >= kShortestStroke * strokes.size();
  return are_strokes ? std::move(strokes) : std::vector<Stroke>{};
}

std::vector<Stroke> cut(std::vector<Stroke> strokes, std::span<const double> force, double middle) {
  for (Stroke& stroke : strokes) stroke = without_ends(stroke, force, middle);
  return strokes;
}

/// The force that lies as far below that of one direction as above that of the other.
double middle_of(std::span<const double> force) {
  const std::vector<double> forces = thinned(force);
  return 0.5 * (quantile_of(forces, 0.05) + quantile_of(forces, 0.95));
}

/// Returns the parts in which the force is alternately on either side of the middle. Slips that nearly reach the middle
/// do not end them.
std::vector<Stroke> sides_beyond_reversals(std::span<const double> force) {
  constexpr double kReversal = 0.5;  // of half the range
  const double middle = middle_of(force);
  return sides_of(force, middle, kReversal * (quantile_of(thinned(force), 0.95) - middle));
}

/// Returns true if the force slips towards the middle from either side of it: in stick-slip in one direction it falls
/// on both sides. Waves and noise rise as quickly as they fall.
bool slip_on_both_sides(const std::vector<Stroke>& sides, std::span<const double> force) {
  constexpr std::size_t kFewest = 8;  // of both sides
  constexpr double kSudden = 2.0;
  const double middle = middle_of(force);
  std::size_t slips = 0;
  for (const bool is_positive : {true, false}) {
    std::size_t strokes = 0;
    std::vector<double> ratios;
    for (const Stroke& side : sides) {
      if (side.is_positive != is_positive) continue;
      ++strokes;
      for (const InnerSlip& slip : inner_slips(own_forces(side, force, middle))) ratios.push_back(slip.rise_over_fall);
    }
    slips += ratios.size();
    if (ratios.size() < strokes || quantile_of(std::move(ratios), 0.5) < kSudden) return false;
  }
  return slips >= kFewest;
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
  const double middle = middle_of(motion.force);
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
  if (is_one_way || strokes.size() <= kSmallestTurns) return {};
  return cut(std::move(strokes), motion.force, middle);
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

/// The strokes of a force that stays at +F and at -F in turn.
std::vector<Stroke> strokes_by_levels(std::span<const double> force) {
  const double near = kNear * level_90(force);
  const auto near_zero = std::ranges::count_if(force, [&](double f) { return std::abs(f) < near; });
  if (static_cast<double>(near_zero) > kMostNear * static_cast<double>(force.size())) return {};
  auto strokes = cut(long_enough(sides_of(force, 0.0, near), force.size(), kFewestByLevel), force, 0.0);
  return are_sides_alike(strokes, force) ? strokes : std::vector<Stroke>{};
}

/// The strokes of a force that slips towards the middle from either side of it, however long it takes to turn.
std::vector<Stroke> strokes_by_slips(std::span<const double> force) {
  auto strokes = long_enough(sides_beyond_reversals(force), force.size(), kFewestBySlips);
  if (!slip_on_both_sides(strokes, force)) return {};
  return cut(std::move(strokes), force, middle_of(force));
}

bool has_both_signs(std::span<const double> force) {
  const auto samples = static_cast<double>(force.size());
  const auto negative = static_cast<double>(std::ranges::count_if(force, [](double f) { return f < 0.0; }));
  return std::min(negative, samples - negative) >= kLeastOfEitherSign * samples;
}

}  // namespace

std::vector<Stroke> find_strokes(const Motion& motion) {
  if (has_both_signs(motion.force)) {
    if (auto strokes = strokes_by_displacement(motion); !strokes.empty()) return strokes;
    if (auto strokes = strokes_by_levels(motion.force); !strokes.empty()) return strokes;
  }
  return strokes_by_slips(motion.force);
}

std::vector<Stroke> take_strokes(const Motion& motion) {
  constexpr double kOtherSign = 0.1;
  if (auto strokes = strokes_by_displacement(motion); !strokes.empty()) return strokes;
  if (auto strokes = strokes_by_slips(motion.force); !strokes.empty()) return strokes;
  const std::vector<double> forces = thinned(motion.force);
  const double low = quantile_of(forces, 0.05);
  const double high = quantile_of(forces, 0.95);
  if (!(low < 0.0 && high > 0.0) || std::min(-low, high) < kOtherSign * std::max(-low, high)) return {};
  auto strokes = long_enough(sides_beyond_reversals(motion.force), motion.force.size(), kFewestBySlips);
  return cut(std::move(strokes), motion.force, middle_of(motion.force));
}

}  // namespace slipfit::reading
