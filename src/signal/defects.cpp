#include "signal/defects.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <boost/sort/pdqsort/pdqsort.hpp>
#include <cmath>
#include <span>
#include <utility>

#include "core/thresholds.hpp"
#include "signal/smoothing.hpp"
#include "slipfit/signal/quality.hpp"

namespace slipfit {

namespace {

/// Noise from differences of one order, their coefficients and the root of the sum of their squares given.
template <std::size_t N>
double difference_noise(std::span<const double> force, const std::array<double, N>& coefficients, double norm) {
  std::vector<double> sizes;
  if (force.size() < N) return 0.0;
  const std::size_t stride = signal::stride_for(force.size());
  sizes.reserve(force.size() / stride + 1);
  for (std::size_t i = 0; i + N <= force.size(); i += stride) {
    double difference = 0.0;
    for (std::size_t k = 0; k < N; ++k) difference += coefficients[k] * force[i + k];
    sizes.push_back(std::abs(difference));
  }
  return signal::kMedianToSigma * signal::median(std::move(sizes)) / norm;
}

/// Second differences do not see ramps, fourth ones do not see the bends of a wave with few samples a period either.
double noise_of(std::span<const double> force) {
  const double second = difference_noise(force, std::array{1.0, -2.0, 1.0}, std::sqrt(6.0));
  const double fourth = difference_noise(force, std::array{1.0, -4.0, 6.0, -4.0, 1.0}, std::sqrt(70.0));
  return force.size() < 5 ? second : std::min(second, fourth);
}

/// More than half of the second differences are nought (values held or rounded): their rms, large ones cut.
double noise_of_held(std::span<const double> force) {
  std::vector<double> sizes;
  for (std::size_t i = 1; i + 1 < force.size(); ++i) {
    const double bend = std::abs(force[i - 1] - 2.0 * force[i] + force[i + 1]);
    if (bend > 0.0) sizes.push_back(bend);
  }
  if (sizes.empty()) return 0.0;
  const double share = static_cast<double>(sizes.size()) / static_cast<double>(force.size());
  return signal::median(std::move(sizes)) * std::sqrt(share / 6.0);
}

void assess_clock(const Recording& recording, Quality& quality) {
  const std::span<const double> time = recording.time_s();
  const double usual = recording.sample_interval_s();
  const std::size_t stride = signal::stride_for(time.size());
  const double gap_s = thresholds::kGapSteps * usual;
  for (std::size_t i = 1; i < time.size(); ++i) quality.gaps += time[i] - time[i - 1] > gap_s ? std::size_t{1} : 0;
  for (std::size_t i = 1; i < time.size() && quality.gaps > 0; ++i) {
    if (const double step = time[i] - time[i - 1]; step > gap_s) {
      quality.longest_gap_s = std::max(quality.longest_gap_s, step);
    }
  }
  std::vector<double> deviations;
  for (std::size_t i = stride; i < time.size(); i += stride) {
    if (const double step = time[i] - time[i - 1]; step <= gap_s) deviations.push_back(std::abs(step - usual));
  }
  quality.clock_jitter = signal::kMedianToSigma * signal::median(std::move(deviations)) / usual;
}

}  // namespace

}  // namespace slipfit

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

/// Flags samples, alone or in pairs, that differ from both sides while the sides agree with each other (so that no
/// peak, trough or fall of a slip is flagged, however few samples it has). Empty: none.
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

/// Step of the lattice on which all values lie, where there is one and fewer than 5 % of the values are distinct.
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

/// Levels at which the values pile up at the ends of their range.
struct Clipping {
  std::optional<double> high;
  std::optional<double> low;
  std::size_t samples = 0;
};

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

/// Many neighbours are equal: worth a closer look, which most recordings are spared.
bool often_repeats(std::span<const double> force) {
  std::size_t equal = 0;
  for (std::size_t i = 1; i < force.size(); ++i) equal += force[i] == force[i - 1] ? 1U : 0U;
  const auto runs = static_cast<double>(force.size() - equal);
  return static_cast<double>(force.size()) > thresholds::kShortestRepeat * runs;
}

/// The number of changes between runs of equal values, and the shortest run.
struct Changes {
  double usual = 0.0;
  double smallest = 0.0;
};

Changes changes_between(std::span<const double> force, const std::vector<std::size_t>& first) {
  std::vector<double> sizes;
  for (std::size_t run = 1; run < first.size(); ++run) {
    sizes.push_back(std::abs(force[first[run]] - force[first[run - 1]]));
  }
  const double smallest = sizes.empty() ? 0.0 : *std::ranges::min_element(sizes);
  return {median(std::move(sizes)), smallest};
}

}  // namespace

std::vector<std::size_t> first_of_repeats(std::span<const double> force) {
  constexpr std::size_t kFewestRuns = 20;
  if (force.empty() || !often_repeats(force)) return {};
  std::vector<std::size_t> first{0};
  for (std::size_t i = 1; i < force.size(); ++i) {
    if (force[i] != force[i - 1]) first.push_back(i);
  }
  if (first.size() < kFewestRuns) return {};
  const Changes changes = changes_between(force, first);
  return changes.usual < thresholds::kRoundingSteps * changes.smallest ? std::vector<std::size_t>{} : first;
}

bool has_gap(const Recording& recording, std::size_t first, std::size_t last) {
  if (recording.clock_is_even()) return false;
  const double gap_s = thresholds::kGapSteps * recording.sample_interval_s();
  const std::span<const double> time_s = recording.time_s();
  for (std::size_t i = first + 1; i <= last; ++i) {
    if (time_s[i] - time_s[i - 1] > gap_s) return true;
  }
  return false;
}

std::vector<double> bridged(std::span<const double> values, const std::vector<bool>& missing) {
  std::vector<double> result(values.begin(), values.end());
  for (auto first = std::ranges::find(missing, true); first != missing.end();) {
    const auto last = std::find(first, missing.end(), false);
    const auto begin = static_cast<std::size_t>(first - missing.begin());
    const auto end = static_cast<std::size_t>(last - missing.begin());
    const double after = end < missing.size() ? values[end] : begin > 0 ? values[begin - 1] : 0.0;
    const double before = begin > 0 ? values[begin - 1] : after;
    for (std::size_t k = begin; k < end; ++k) {
      result[k] = before + (after - before) * static_cast<double>(k + 1 - begin) / static_cast<double>(end + 1 - begin);
    }
    first = std::find(last, missing.end(), true);
  }
  return result;
}

}  // namespace slipfit::signal

namespace slipfit {

Quality assess_quality(const Recording& recording) {
  Quality quality;
  const std::span<const double> force = recording.force();
  const std::optional<double> step = signal::lattice_step(force);
  quality.noise_rms = noise_of(force);
  if (quality.noise_rms <= 0.0) quality.noise_rms = noise_of_held(force);
  if (step) {
    quality.quantisation_step = step;
    quality.noise_rms = std::max(quality.noise_rms, *step / std::sqrt(12.0));  // rounding alone makes that much
  }
  const signal::Clipping clipping = signal::find_clipping(force, step);
  quality.clip_high = clipping.high;
  quality.clip_low = clipping.low;
  quality.clipped_samples = clipping.samples;
  quality.impulse_mask = signal::find_impulses(force, quality.noise_rms);
  quality.impulses = static_cast<std::size_t>(std::ranges::count(quality.impulse_mask, true));
  assess_clock(recording, quality);
  return quality;
}

}  // namespace slipfit
