#include "signal/events.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "core/parallel.hpp"
#include "core/thresholds.hpp"
#include "signal/smoothing.hpp"

namespace slipfit::signal {

/// Adds a block of values. If nothing can turn in a block, whatever the order of its values, only the highest or lowest
/// value so far moves. Blocks are small because a ramp rises more within a longer one.
void TurningPoints::add(std::size_t first, std::span<const double> values) {
  constexpr std::size_t kBlock = 8;
  std::size_t i = 0;
  for (; i + kBlock <= values.size(); i += kBlock) {
    const double* const block = &values[i];
    const Eigen::Map<const Eigen::Array<double, kBlock, 1>> looked_at(block);
    const double low = looked_at.minCoeff();
    const double high = looked_at.maxCoeff();
    const auto place_of = [&](double value) {
      return first + i + static_cast<std::size_t>(std::find(block, block + kBlock, value) - block);
    };
    if (falling_ && high <= std::min(lowest_, low) + hysteresis_) {
      if (low >= lowest_) continue;
      low_ = place_of(low);
      lowest_ = low;
    } else if (!falling_ && low >= std::max(highest_, high) - hysteresis_) {
      if (high <= highest_) continue;
      high_ = place_of(high);
      highest_ = high;
    } else {
      for (std::size_t k = 0; k < kBlock; ++k) add(first + i + k, block[k]);
    }
  }
  for (; i < values.size(); ++i) add(first + i, values[i]);
}

namespace {

/// A turning point of a trace.
struct Turn {
  std::size_t at = 0;  ///< place in the trace
  double value = 0.0;
};

/// A fall from one turning point to the next.
struct SeenFall {
  Turn peak;
  Turn trough;

  [[nodiscard]] double drop() const { return peak.value - trough.value; }
};

/// Returns the size of the change per place from one turning point to a later one.
double rate(const Turn& from, const Turn& to) {
  return std::abs(to.value - from.value) / static_cast<double>(std::max<std::size_t>(1, to.at - from.at));
}

/// Rate of the fall itself.
double rate(const SeenFall& fall) {
  return rate(fall.peak, fall.trough);
}

/// The falls of one trace at hystereses that grow: each pass goes over the turning points of the one before.
class Falls {
 public:
  /// The falls that exceed noise of this standard deviation.
  Falls(const Means& trace, double noise);

  /// Highest less lowest value of the trace.
  [[nodiscard]] double range() const { return range_; }
  /// The hysteresis that they were found with: noise makes no turning point of 8 standard deviations; rounding errors
  /// are no motion.
  [[nodiscard]] double smallest() const { return smallest_; }

  /// Increases the hysteresis; returns false if no turning point is too small, so that the falls are unchanged.
  bool coarsen(double hysteresis);

  /// Returns the falls larger than a hysteresis in their order; ringing is joined.
  [[nodiscard]] std::vector<SeenFall> beyond(double hysteresis) const;

 private:
  [[nodiscard]] TurningPoints turning_points(double hysteresis) const;

  double range_ = 0.0;
  double smallest_ = 0.0;
  std::vector<Turn> turns_;
};

/// The trace in pieces that stay in the cache: f(place of the first value, values).
template <class F>
void for_each_piece(const Means& trace, const F& f) {
  std::array<double, 512> piece{};
  for (std::size_t first = 0; first < trace.size(); first += piece.size()) {
    const std::span<double> values(piece.data(), std::min(piece.size(), trace.size() - first));
    trace.copy(first, values);
    f(first, values);
  }
}

struct Extent {
  double low = HUGE_VAL;
  double high = -HUGE_VAL;

  void add(std::span<const double> values) {
    const Eigen::Map<const Eigen::ArrayXd> looked_at(values.data(), std::ssize(values));
    low = std::min(low, looked_at.minCoeff());
    high = std::max(high, looked_at.maxCoeff());
  }
  [[nodiscard]] double range() const { return std::max(0.0, high - low); }
};

/// The values processed so far and their turning points.
struct Passed {
  double range = 0.0;
  std::vector<std::size_t> turns;
};

Passed pass(const Means& trace, double hysteresis) {
  Extent extent;
  TurningPoints turns(hysteresis);
  for_each_piece(trace, [&](std::size_t first, std::span<const double> values) {
    extent.add(values);
    turns.add(first, values);
  });
  return {extent.range(), turns.turns()};
}

double range_of(const Means& trace) {
  Extent extent;
  for_each_piece(trace, [&](std::size_t, std::span<const double> values) { extent.add(values); });
  return extent.range();
}

/// Joins falls between which the force rises nearly as quickly as it falls: there the body or the load cell rings. If
/// the other rises are no slower, nothing rings: it is a wave, and the falls are returned unchanged.
std::vector<SeenFall> joined(std::vector<SeenFall> falls) {
  constexpr std::size_t kFewest = 3;
  std::vector<SeenFall> result;
  std::vector<double> sticks, rings;
  double before = 0.0;
  for (std::size_t i = 0; i < falls.size(); ++i) {
    const SeenFall& fall = falls[i];
    const double own = rate(fall);
    const double rise = i == 0 ? 0.0 : rate(falls[i - 1].trough, fall.peak);
    const bool rings_on = rise > thresholds::kRingingRise * std::max(own, before);
    before = own;
    if (i > 0) (rings_on ? rings : sticks).push_back(rise);
    if (!rings_on) {
      result.push_back(fall);
    } else if (fall.trough.value < result.back().trough.value) {
      result.back().trough = fall.trough;
    }
  }
  const bool is_separable = median(std::move(sticks)) < thresholds::kRingApart * median(std::move(rings));
  return is_separable && result.size() >= kFewest ? result : falls;
}

Falls::Falls(const Means& trace, double noise) {
  const auto smallest_of = [noise](double range) { return std::max(thresholds::kNoiseSigmas * noise, 1e-9 * range); };
  // Where there is no noise the range has to be known beforehand: every rounding error would turn.
  smallest_ = smallest_of(noise > 0.0 ? 0.0 : range_of(trace));
  Passed passed = pass(trace, smallest_);
  if (smallest_of(passed.range) > smallest_) {
    smallest_ = smallest_of(passed.range);
    passed = pass(trace, smallest_);
  }
  range_ = passed.range;
  turns_.reserve(passed.turns.size());
  if (trace.size() == 0) return;
  for (const std::size_t at : passed.turns) turns_.push_back({at, trace[at]});
}

TurningPoints Falls::turning_points(double hysteresis) const {
  TurningPoints turns(hysteresis);
  for (std::size_t i = 0; i < turns_.size(); ++i) turns.add(i, turns_[i].value);
  return turns;
}

bool Falls::coarsen(double hysteresis) {
  const std::size_t before = turns_.size();
  std::vector<Turn> left;
  for (const std::size_t i : turning_points(hysteresis).turns()) left.push_back(turns_[i]);
  turns_ = std::move(left);
  return turns_.size() < before;
}

std::vector<SeenFall> Falls::beyond(double hysteresis) const {
  std::vector<SeenFall> falls;
  const TurningPoints turns = turning_points(hysteresis);
  for (const Fall& fall : turns.falls()) falls.push_back({turns_[fall.peak], turns_[fall.trough]});
  return joined(std::move(falls));
}

struct Detection {
  std::vector<SeenFall> falls;
  double drop = 0.0;       ///< median
  double asymmetry = 1.0;  ///< median rise over median fall, in time
  double hysteresis = 0.0;
  double score = 0.0;
  std::size_t minor = 0;  ///< falls too small to count
};

std::vector<double> drops_of(const std::vector<SeenFall>& falls) {
  std::vector<double> drops;
  drops.reserve(falls.size());
  for (const SeenFall& fall : falls) drops.push_back(fall.drop());
  return drops;
}

double asymmetry_of(const std::vector<SeenFall>& falls) {
  std::vector<double> rises, times;
  for (std::size_t i = 0; i < falls.size(); ++i) {
    times.push_back(static_cast<double>(falls[i].trough.at - falls[i].peak.at));
    if (i > 0) rises.push_back(static_cast<double>(falls[i].peak.at - falls[i - 1].trough.at));
  }
  return median(std::move(rises)) / std::max(1.0, median(std::move(times)));
}

/// Falls on either side of which the force rises as quickly are a wave's, where most are sudden; small ones already
/// where it does on one side.
void remove_waves(std::vector<SeenFall>& falls, double usual_drop) {
  std::vector<double> rises, own_rates;
  for (std::size_t i = 1; i < falls.size(); ++i) {
    rises.push_back(rate(falls[i - 1].trough, falls[i].peak));
    own_rates.push_back(rate(falls[i]));
  }
  if (median(std::move(rises)) > thresholds::kSuddenRate * median(std::move(own_rates))) return;
  std::vector<SeenFall> sudden;
  const double small = 0.5 * usual_drop;
  for (std::size_t i = 0; i < falls.size(); ++i) {
    const double own = thresholds::kWaveRise * rate(falls[i]);
    const bool before = i > 0 && rate(falls[i - 1].trough, falls[i].peak) > own;
    const bool after = i + 1 < falls.size() && rate(falls[i].trough, falls[i + 1].peak) > own;
    const bool is_wave = falls[i].drop() < small ? before || after : before && after;
    if (!is_wave) sudden.push_back(falls[i]);
  }
  falls = std::move(sudden);
}

/// Falls of at least a quarter of the median, seen with a hysteresis to match.
Detection detect_beyond(const Falls& falls, double hysteresis) {
  Detection detection;
  detection.hysteresis = std::max(falls.smallest(), hysteresis);
  detection.falls = falls.beyond(detection.hysteresis);
  detection.drop = median(drops_of(detection.falls));
  const double quarter = thresholds::kCountedDrop * detection.drop;
  const auto is_small = [quarter](const SeenFall& fall) { return fall.drop() < quarter; };
  if (std::erase_if(detection.falls, is_small) > 0) detection.drop = median(drops_of(detection.falls));
  const std::size_t counted = detection.falls.size();
  remove_waves(detection.falls, detection.drop);
  if (detection.falls.size() < counted) detection.drop = median(drops_of(detection.falls));
  detection.asymmetry = asymmetry_of(detection.falls);
  return detection;
}

constexpr double kSameCount = 1.05;     // ratio of two numbers of falls that are the same
constexpr double kWave = 2.0;           // asymmetry up to which falls may be those of a wave on a ramp
constexpr double kMostAsymmetry = 6.0;  // sampling and smoothing do not distinguish quicker falls than this

/// A single fall has no rise to the next one: it counts where the force took its time to get there.
double score_of(const Detection& detection, double noise) {
  if (detection.falls.empty()) return 0.0;
  const SeenFall& first = detection.falls.front();
  const auto length = static_cast<double>(first.trough.at - first.peak.at);
  if (detection.falls.size() == 1 && static_cast<double>(first.peak.at) < thresholds::kLeastAlone * length) return 0.0;
  constexpr double kClear = 40.0;  // beyond, a larger fall is no better seen
  const double is_prominent = 1.0 / (1.0 / kClear + noise / detection.drop);
  // Rises twice as long as the falls may be those of a wave on a ramp: they say little more than equal ones.
  const double asymmetry = detection.falls.size() == 1 ? 1.0 : std::min(detection.asymmetry, kMostAsymmetry);
  constexpr double kRise = kMostAsymmetry / (kMostAsymmetry - 1.0);
  const double sudden = std::max(std::min(asymmetry, kRise), kRise * (asymmetry - 1.0));
  return is_prominent * std::sqrt(static_cast<double>(detection.falls.size())) * sudden;
}

/// Falls that were seen, in numbers.
struct Seen {
  double drop = 0.0;
  double count = 0.0;
  bool is_sudden = false;

  /// Sum of the squares of the drops, about.
  [[nodiscard]] double variance() const { return count * drop * drop; }
};

/// The result at one time scale.
struct Scale {
  Means trace;
  double noise = 0.0;
  Detection best{};
  std::vector<Seen> seen{};  ///< at every hysteresis
};

Seen seen_of(const Detection& detection) {
  return {detection.drop, static_cast<double>(detection.falls.size()), detection.asymmetry > kWave};
}

/// `least_drop`: of falls, by the median.
Scale falls_at_scale(const Means& trace, double noise, double least_drop) {
  Scale scale{trace, noise};
  const Falls all(trace, noise);
  if (!(all.range() > 0.0)) return scale;
  Falls falls = all;
  constexpr double kRatio = 1.5;
  bool is_first = true;
  for (double hysteresis = std::max(all.smallest(), 1e-3 * all.range()); hysteresis < all.range();
       hysteresis *= kRatio) {
    const bool is_new = falls.coarsen(hysteresis) || is_first;
    if (!is_new) continue;  // it would look the same
    is_first = false;
    Detection detection = detect_beyond(falls, hysteresis);
    scale.seen.push_back(seen_of(detection));
    detection.score = detection.drop < least_drop ? 0.0 : score_of(detection, noise);
    if (detection.score > scale.best.score) scale.best = std::move(detection);
  }
  // As small a hysteresis as the counted falls allow: it finds each fall's own turning points.
  Detection last = detect_beyond(all, 0.25 * scale.best.drop);
  Detection finer = last.drop == scale.best.drop ? last : detect_beyond(all, 0.25 * last.drop);
  const auto count = [](const Detection& detection) { return static_cast<double>(detection.falls.size()); };
  if (count(finer) < kSameCount * count(last)) last = std::move(finer);
  last.score = score_of(last, noise);
  const std::size_t noticed = all.beyond(std::max(all.smallest(), 0.1 * scale.best.drop)).size();
  last.minor = noticed - std::min(noticed, last.falls.size());
  if (scale.best.drop > 0.0) scale.best = std::move(last);
  return scale;
}

bool shows_the_same(const Detection& fine, const Detection& best) {
  const auto count = [](const Detection& detection) { return static_cast<double>(detection.falls.size()); };
  return std::abs(count(fine) - count(best)) <= std::max(1.0, (kSameCount - 1.0) * count(best)) &&
         std::min(fine.asymmetry, kMostAsymmetry) > 0.8 * std::min(best.asymmetry, kMostAsymmetry);
}

/// One mean a sample, the ends held.
std::vector<double> mean_a_sample(const Means& fine, std::size_t samples) {
  std::vector<double> trace(samples);
  const std::size_t begin = fine.width() / 2;
  const std::size_t end = begin + fine.size();
  fine.copy(0, std::span(trace).subspan(begin, fine.size()));
  std::fill_n(trace.begin(), begin, trace[begin]);
  std::fill_n(trace.begin() + static_cast<std::ptrdiff_t>(end), samples - end, trace[end - 1]);
  return trace;
}

/// The turning points moved to where the trace with one mean a sample turns.
void place_on_samples(const Scale& scale, Events& events) {
  const std::size_t samples = events.trace.size();
  const auto at = [&](std::size_t i) { return events.trace.begin() + static_cast<std::ptrdiff_t>(i); };
  const auto around = [&](std::size_t j) {
    const std::size_t i = scale.trace.sample(j);
    return std::pair(at(i - std::min(i, scale.trace.stride())), at(std::min(samples, i + scale.trace.stride() + 1)));
  };
  for (const SeenFall& fall : scale.best.falls) {
    const auto [peak_begin, peak_end] = around(fall.peak.at);
    const auto [trough_begin, trough_end] = around(fall.trough.at);
    const auto peak = std::max_element(peak_begin, peak_end);
    const auto trough = std::min_element(std::max(trough_begin, peak + 1), std::max(trough_end, peak + 2));
    events.falls.push_back({static_cast<std::size_t>(peak - at(0)), static_cast<std::size_t>(trough - at(0))});
  }
}

/// In equal ratios, up to what leaves some 50 means.
std::vector<double> widths_of(std::size_t samples) {
  std::vector<double> widths;
  for (double width = 1.0; width <= 0.02 * static_cast<double>(samples) || width < 2.0; width *= 1.5) {
    widths.push_back(width);
  }
  return widths;
}

/// Detects at every scale; falls have to be of `least_drop`.
std::vector<Scale> falls_at_scales(const std::vector<double>& force, const RunningMeans& means, double noise,
                                   const std::vector<double>& widths, double least_drop) {
  constexpr std::size_t kLarge = 200000;  // samples from which a second thread is worth its start
  const auto at_width = [&](std::size_t i) {
    const auto samples = static_cast<std::size_t>(std::lround(widths[i]));
    const Means trace(force, means, samples, std::max<std::size_t>(1, samples / 3));
    const double left = std::max(noise / std::sqrt(widths[i]), samples == 1 ? 0.0 : noise_of(trace));
    return falls_at_scale(trace, left, least_drop);
  };
  return in_parallel(widths.size(), at_width, force.size() < kLarge ? 1 : widths.size());
}

std::size_t best_of(const std::vector<Scale>& scales) {
  const auto score = [](const Scale& scale) { return scale.best.score; };
  return static_cast<std::size_t>(std::ranges::max_element(scales, {}, score) - scales.begin());
}

/// Returns true if sudden falls were seen to which these are noise, and which move the force more. Noise after a
/// filter is as smooth as slips, and it has more falls.
bool are_noise(const Detection& falls, const std::vector<Scale>& scales) {
  const Seen these = seen_of(falls);
  return std::ranges::any_of(scales, [&](const Scale& scale) {
    return std::ranges::any_of(scale.seen, [&](const Seen& others) {
      return others.is_sudden && others.count >= thresholds::kFewestCycles &&
             others.drop > thresholds::kNoiseSigmas * these.drop && others.variance() > these.variance();
    });
  });
}

}  // namespace

Events find_events(std::vector<double> force, double noise, std::optional<std::size_t> width) {
  const RunningMeans means(force);
  const std::vector<double> widths = width ? std::vector{static_cast<double>(*width)} : widths_of(force.size());
  std::vector<Scale> scales = falls_at_scales(force, means, noise, widths, 0.0);
  std::size_t best = best_of(scales);
  for (double least_drop = 0.0; are_noise(scales[best].best, scales);) {
    least_drop = std::max(2.0 * least_drop, thresholds::kNoiseSigmas * scales[best].best.drop);
    scales = falls_at_scales(force, means, noise, widths, least_drop);
    best = best_of(scales);
  }
  std::size_t chosen = 0;
  while (chosen < best && !shows_the_same(scales[chosen].best, scales[best].best)) ++chosen;
  const Scale& scale = scales[chosen];
  Events events;
  events.width = scale.trace.width();
  events.noise = scale.noise;
  events.hysteresis = scale.best.hysteresis;
  events.minor = scale.best.minor;
  if (scale.trace.width() > 1) {
    events.trace = mean_a_sample(Means(force, means, scale.trace.width(), 1), force.size());
    place_on_samples(scale, events);
  } else {
    for (const SeenFall& fall : scale.best.falls) events.falls.push_back({fall.peak.at, fall.trough.at});
    events.trace = std::move(force);
  }
  return events;
}

}  // namespace slipfit::signal
