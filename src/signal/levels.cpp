#include "signal/defects.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <boost/sort/pdqsort/pdqsort.hpp>
#include <cmath>

#include "core/thresholds.hpp"

namespace slipfit::signal {
namespace {

constexpr std::size_t kSorted = 10000;  // values looked at for the step; all are checked against it
constexpr std::size_t kFew = 500;       // enough to see that there is none
constexpr double kLargestStep = 1.5;    // of step_of, in smallest gaps: one of 1.5 still counts as one step

std::vector<double> some_of(std::span<const double> values, std::size_t most) {
  const std::size_t stride = 1 + (values.size() - 1) / most;
  std::vector<double> some;
  for (std::size_t i = 0; i < values.size(); i += stride) some.push_back(values[i]);
  return some;
}

std::vector<double> distinct_of(std::vector<double> values) {
  boost::sort::pdqsort_branchless(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

double smallest_gap(const std::vector<double>& distinct) {
  double smallest = distinct.back() - distinct.front();
  for (std::size_t i = 1; i < distinct.size(); ++i) smallest = std::min(smallest, distinct[i] - distinct[i - 1]);
  return smallest;
}

/// Smallest gap, then the range over the number of steps in it: the gaps carry the rounding of the file, the range
/// carries it once.
std::optional<double> step_of(const std::vector<double>& distinct) {
  if (distinct.size() < 2) return std::nullopt;
  const double smallest = smallest_gap(distinct);
  double steps = 0.0;
  for (std::size_t i = 1; i < distinct.size(); ++i) steps += std::round((distinct[i] - distinct[i - 1]) / smallest);
  return (distinct.back() - distinct.front()) / steps;
}

/// Rounds like std::round up to 2^51 without its function call (SSE2 has no instruction for it).
double nearest_whole(double value) {
  constexpr double kShift = 0x1.8p52;
  return (value + kShift) - kShift;
}

/// All values on the lattice, and how many places of it they take.
bool fills_lattice(std::span<const double> values, double origin, double lowest, double highest, double step) {
  const double places = (highest - lowest) / step + 2.0;
  if (!(places < static_cast<double>(values.size()))) return false;
  const double per_step = 1.0 / step;
  const double first = nearest_whole((lowest - origin) * per_step);
  std::vector<unsigned char> taken(static_cast<std::size_t>(places) + 1, 0);  // bits would cost twice the time
  for (const double value : values) {
    const double place = (value - origin) * per_step;
    const double nearest = nearest_whole(place);
    if (std::abs(place - nearest) > thresholds::kOffLattice) return false;
    taken[static_cast<std::size_t>(std::clamp(nearest - first, 0.0, places))] = 1;
  }
  const auto distinct = static_cast<double>(std::ranges::count(taken, 1));
  return distinct >= 2.0 && distinct < thresholds::kDistinctShare * static_cast<double>(values.size());
}

/// The samples at one end of the range (`sign` +1: the highest values), if they pile up there.
std::size_t piled_up(std::span<const double> values, double sign, double end) {
  const auto at_end = static_cast<std::size_t>(std::ranges::count(values, end));
  // Half of all samples at one level is a force at rest, not a sensor at its end.
  if (static_cast<double>(at_end) <= thresholds::kClippedPile || 2 * at_end >= values.size()) return 0;
  double next = -sign * HUGE_VAL;
  for (const double value : values) {
    if (value != end && sign * value > sign * next) next = value;
  }
  const auto at_next = std::ranges::count(values, next);
  return static_cast<double>(at_end) > thresholds::kClippedPile * static_cast<double>(at_next) ? at_end : 0;
}

}  // namespace

std::optional<double> lattice_step(std::span<const double> values) {
  const Eigen::Map<const Eigen::ArrayXd> all(values.data(), std::ssize(values));
  const double lowest = all.minCoeff();
  const double highest = all.maxCoeff();
  std::vector<double> some = some_of(values, kSorted);
  const std::vector<double> few = distinct_of(some_of(some, kFew));
  const double finest = (highest - lowest) / static_cast<double>(values.size());  // of fewer places than values
  if (few.size() > 1 && kLargestStep * smallest_gap(few) < finest) return std::nullopt;
  const std::vector<double> distinct = distinct_of(std::move(some));
  const std::optional<double> step = step_of(distinct);
  if (!step || !std::isfinite(*step)) return std::nullopt;
  if (!fills_lattice(values, distinct.front(), lowest, highest, *step)) return std::nullopt;
  return step;
}

Clipping find_clipping(std::span<const double> values, std::optional<double> step) {
  Clipping clipping;
  const Eigen::Map<const Eigen::ArrayXd> all(values.data(), std::ssize(values));
  const double lowest = all.minCoeff();
  const double highest = all.maxCoeff();
  // On a coarse lattice neighbouring levels fill very differently: four steps of range do not make an end.
  if (highest - lowest <= 4.0 * step.value_or(0.0)) return clipping;
  if (const std::size_t high = piled_up(values, 1.0, highest)) {
    clipping.high = highest;
    clipping.samples += high;
  }
  if (const std::size_t low = piled_up(values, -1.0, lowest)) {
    clipping.low = lowest;
    clipping.samples += low;
  }
  return clipping;
}

}  // namespace slipfit::signal
