#include "signal/stretch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/statistics.hpp"
#include "core/thresholds.hpp"
#include "signal/smoothing.hpp"

namespace slipfit::signal {
namespace {

/// Typical properties of the falls of a trace.
struct Usual {
  double drop = 0.0;        ///< median
  double large_drop = 0.0;  ///< 90 % are smaller
  double interval = 0.0;    ///< samples, median
  double long_interval = 0.0;
  double rise_rate = 0.0;  ///< force a sample, median
};

class Train {
 public:
  Train(const std::vector<double>& force, const std::vector<Fall>& falls) : force_(force), falls_(falls) {
    std::vector<double> drops, intervals, rates;
    for (std::size_t i = 0; i < falls.size(); ++i) {
      drops.push_back(drop(i));
      if (i == 0) continue;
      intervals.push_back(interval(i));
      rates.push_back((peak(i) - trough(i - 1)) / static_cast<double>(falls[i].peak - falls[i - 1].trough + 1));
    }
    usual_ = {median(drops), quantile_of(drops, 0.9), median(intervals), quantile_of(intervals, 0.9), median(rates)};
  }

  [[nodiscard]] double peak(std::size_t i) const { return force_[falls_[i].peak]; }
  [[nodiscard]] double trough(std::size_t i) const { return force_[falls_[i].trough]; }
  [[nodiscard]] double drop(std::size_t i) const { return peak(i) - trough(i); }
  [[nodiscard]] double interval(std::size_t i) const {
    return static_cast<double>(falls_[i].peak - falls_[i - 1].peak);
  }
  [[nodiscard]] const Usual& usual() const { return usual_; }

  /// Returns true if fall i belongs to the same sliding as the previous one, without a pause between them.
  [[nodiscard]] bool follows(std::size_t i) const {
    const double loading = (peak(i) - trough(i - 1)) / usual_.rise_rate;
    const double longest_pause = thresholds::kLongestPauseRatio * std::max(usual_.long_interval, loading);
    return interval(i) < longest_pause;
  }

 private:
  const std::vector<double>& force_;
  const std::vector<Fall>& falls_;
  Usual usual_;
};

/// Falls [first, last] of the longest train.
struct Run {
  std::size_t first = 0;
  std::size_t last = 0;

  [[nodiscard]] std::size_t count() const { return last - first + 1; }
};

Run longest_run(const Train& train, std::size_t falls) {
  Run best{0, 0};
  Run run{0, 0};
  for (std::size_t i = 1; i < falls; ++i) {
    run = train.follows(i) ? Run{run.first, i} : Run{i, i};
    if (run.count() > best.count()) best = run;
  }
  return best;
}

/// Lowest and highest force that the run's cycles reach, with room for half a drop.
struct Band {
  double low = 0.0;
  double high = 0.0;
};

Band band_of(const Train& train, Run run) {
  std::vector<double> peaks, troughs;
  for (std::size_t i = run.first; i <= run.last; ++i) {
    peaks.push_back(train.peak(i));
    if (i < run.last) troughs.push_back(train.trough(i));
  }
  const double room = 0.5 * train.usual().large_drop;
  return {*std::ranges::min_element(troughs) - room, *std::ranges::max_element(peaks) + room};
}

bool within(std::span<const double> force, Band band) {
  return std::ranges::all_of(force, [&](double f) { return f >= band.low && f <= band.high; });
}

/// Back from the first peak along its stick, down to the trough of the slips that follow.
std::size_t begin_of(const std::vector<double>& force, const std::vector<Fall>& falls, const Train& train, Run run,
                     double reach) {
  std::vector<double> troughs;
  for (std::size_t i = run.first; i <= std::min(run.last, run.first + 4); ++i) troughs.push_back(train.trough(i));
  const double low = median(std::move(troughs));
  const std::size_t peak = falls[run.first].peak;
  const std::size_t earliest = peak - std::min(peak, static_cast<std::size_t>(reach));
  std::size_t begin = peak;
  while (begin > earliest && force[begin - 1] > low) --begin;
  return begin;
}

/// On from the last trough as far as the force stays in the band.
std::size_t end_of(const std::vector<double>& force, const std::vector<Fall>& falls, Run run, Band band, double reach) {
  std::size_t end = falls[run.last].trough + 1;
  const std::size_t latest = std::min(force.size(), falls[run.last].peak + static_cast<std::size_t>(reach));
  while (end < latest && force[end] >= band.low) ++end;
  return end;
}

}  // namespace

SampleRange sliding_stretch(const std::vector<double>& force, const std::vector<Fall>& falls) {
  const SampleRange whole{0, force.size()};
  if (falls.size() < thresholds::kFewestSlips) return whole;
  const Train train(force, falls);
  if (!(train.usual().rise_rate > 0.0)) return whole;
  Run run = longest_run(train, falls.size());
  if (run.count() < thresholds::kFewestSlips) return whole;
  Band band = band_of(train, run);
  SampleRange stretch;
  // The last fall is the release where the force does not stay among the others' troughs.
  const bool released = train.trough(run.last) < band.low;
  if (released) {
    stretch.end = falls[run.last].peak;
    --run.last;
    band = band_of(train, run);
  }
  double longest = train.usual().interval;
  for (std::size_t i = run.first + 1; i <= run.last; ++i) longest = std::max(longest, train.interval(i));
  stretch.begin = begin_of(force, falls, train, run, 1.2 * longest);
  if (!released) stretch.end = end_of(force, falls, run, band, 1.2 * longest);
  const double usual = train.usual().interval;
  const SampleRange before{0, stretch.begin};
  const SampleRange after{stretch.end, force.size()};
  if (static_cast<double>(before.size()) < usual && within(before.of(force), band)) stretch.begin = 0;
  if (static_cast<double>(after.size()) < usual && within(after.of(force), band)) {
    stretch.end = force.size();
  }
  return stretch;
}

namespace {

/// Medians of blocks of the trace.
struct Blocks {
  std::size_t samples = 0;  ///< a block
  std::vector<double> level;
};

Blocks blocks_of(std::span<const double> force) {
  constexpr std::size_t kBlocks = 200;
  constexpr std::size_t kFewestSamples = 5;
  Blocks blocks;
  blocks.samples = std::max(kFewestSamples, force.size() / kBlocks);
  for (std::size_t begin = 0; begin + blocks.samples <= force.size(); begin += blocks.samples) {
    const auto block = force.subspan(begin, blocks.samples);
    blocks.level.push_back(median({block.begin(), block.end()}));
  }
  return blocks;
}

/// Otsu's method: the value that parts the levels into two classes whose means differ most, weighted by their sizes.
/// Between the means of the classes.
struct Split {
  double low = 0.0;
  double high = 0.0;
};

Split split_of(std::vector<double> levels) {
  std::ranges::sort(levels);
  double total = 0.0;
  for (const double level : levels) total += level;
  const auto count = static_cast<double>(levels.size());
  Split best;
  double most = 0.0, below = 0.0;
  for (std::size_t i = 1; i < levels.size(); ++i) {
    below += levels[i - 1];
    const auto first = static_cast<double>(i);
    const Split split{below / first, (total - below) / (count - first)};
    const double between = first * (count - first) * (split.high - split.low) * (split.high - split.low);
    if (between > most) {
      most = between;
      best = split;
    }
  }
  return best;
}

/// Blocks [begin, end) of the longest run above this level.
SampleRange longest_above(const std::vector<double>& levels, double middle) {
  SampleRange best, run;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (levels[i] <= middle) {
      run = {i + 1, i + 1};
      continue;
    }
    run.end = i + 1;
    if (run.size() > best.size()) best = run;
  }
  return best;
}

}  // namespace

SampleRange plateau(std::span<const double> force) {
  const SampleRange whole{0, force.size()};
  const Blocks blocks = blocks_of(force);
  if (blocks.level.size() < thresholds::kFewestPlateauBlocks) return whole;
  const Split split = split_of(blocks.level);
  if (!(split.high > split.low)) return whole;
  const double middle = 0.5 * (split.low + split.high);
  // The zero of the sensor may be unknown: rest is recognised by its position.
  if (blocks.level.front() > middle || blocks.level.back() > middle) return whole;
  SampleRange run = longest_above(blocks.level, middle);
  if (run.size() == 0) return whole;  // levels that differ by their rounding alone
  // What the level does in the middle of the run is how it moves while the body slides.
  const std::size_t edge = run.size() / 4;
  const auto [low, high] = std::minmax_element(blocks.level.begin() + static_cast<std::ptrdiff_t>(run.begin + edge),
                                               blocks.level.begin() + static_cast<std::ptrdiff_t>(run.end - edge));
  const double movement = *high - *low;
  const double lowest = *low - 0.5 * movement;
  const double highest = *high + 0.5 * movement;
  const auto is_loading = [&](std::size_t i) { return blocks.level[i] < lowest || blocks.level[i] > highest; };
  while (run.begin < run.end && is_loading(run.begin)) ++run.begin;
  while (run.begin < run.end && is_loading(run.end - 1)) --run.end;
  if (run.size() == 0) return whole;
  // The blocks at its ends are partly of the loading and of the release.
  const std::size_t begin = run.begin == 0 ? 0 : (run.begin + 1) * blocks.samples;
  const std::size_t end = run.end == blocks.level.size() ? force.size() : (run.end - 1) * blocks.samples;
  if (end < begin + thresholds::kFewestPlateauBlocks * blocks.samples) return whole;
  return {begin, end};
}

}  // namespace slipfit::signal
