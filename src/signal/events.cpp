#include "signal/events.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/slip_thresholds.hpp"
#include "core/thresholds.hpp"
#include "signal/robust.hpp"
#include "signal/smoothing.hpp"

namespace slipfit::signal {
namespace {

struct Look {
  std::vector<Fall> falls;
  double drop = 0.0;       ///< median
  double asymmetry = 1.0;  ///< median rise over median fall, in time
  double hysteresis = 0.0;
  double score = 0.0;
  std::size_t minor = 0;  ///< falls too small to count
};

double drop_of(const Fall& fall, const std::vector<double>& values) {
  return values[fall.peak] - values[fall.trough];
}

double rate(const std::vector<double>& values, std::size_t from, std::size_t to) {
  return std::abs(values[to] - values[from]) / static_cast<double>(std::max<std::size_t>(1, to - from));
}

/// A slip in two steps: what rises between is small and short.
bool is_pause(const std::vector<double>& values, const Fall& first, const Fall& second) {
  const double rise = values[second.peak] - values[first.trough];
  const auto rise_time = static_cast<double>(second.peak - first.trough);
  const auto fall_time = static_cast<double>(first.trough - first.peak + second.trough - second.peak);
  return rise < thresholds::kPauseRise * std::min(drop_of(first, values), drop_of(second, values)) &&
         rise_time < thresholds::kPauseTime * fall_time;
}

/// Falls whose rise between is nearly as quick as they are belong together: the body or the load cell rings. Where the
/// rises that are left are no slower than those, nothing rings: it is a wave. Then the falls as they were.
std::vector<Fall> joined(const std::vector<Fall>& falls, const std::vector<double>& values) {
  constexpr std::size_t kFewest = 3;
  std::vector<Fall> result;
  std::vector<double> sticks, rings;
  double before = 0.0;
  std::size_t low = 0;
  for (std::size_t i = 0; i < falls.size(); ++i) {
    const Fall& fall = falls[i];
    const double own = rate(values, fall.peak, fall.trough);
    const double rise = result.empty() ? 0.0 : rate(values, low, fall.peak);
    const bool rings_on = rise > thresholds::kRingingRise * std::max(own, before) ||
                          (!result.empty() && is_pause(values, falls[i - 1], fall));
    before = own;
    low = fall.trough;
    if (!result.empty()) (rings_on ? rings : sticks).push_back(rise);
    if (!rings_on) {
      result.push_back(fall);
    } else if (values[fall.trough] < values[result.back().trough]) {
      result.back().trough = fall.trough;
    }
  }
  const bool told_apart = median(std::move(sticks)) < thresholds::kRingApart * median(std::move(rings));
  return told_apart && result.size() >= kFewest ? result : falls;
}

std::vector<double> drops_of(const std::vector<Fall>& falls, const std::vector<double>& values) {
  std::vector<double> drops;
  drops.reserve(falls.size());
  for (const Fall& fall : falls) drops.push_back(drop_of(fall, values));
  return drops;
}

double asymmetry_of(const std::vector<Fall>& falls) {
  std::vector<double> rises, times;
  for (std::size_t i = 0; i < falls.size(); ++i) {
    times.push_back(static_cast<double>(falls[i].trough - falls[i].peak));
    if (i > 0) rises.push_back(static_cast<double>(falls[i].peak - falls[i - 1].trough));
  }
  return median(std::move(rises)) / std::max(1.0, median(std::move(times)));
}

/// The falls of one trace at hystereses that grow: each pass goes over the turning points of the one before.
class Falls {
 public:
  Falls(const std::vector<double>& values, double smallest) : values_(values) {
    TurningPoints turns(smallest);
    for (std::size_t i = 0; i < values.size(); ++i) turns.add(i, values[i]);
    turns_ = turns.turns();
  }

  void coarsen(double hysteresis) { turns_ = turning_points(hysteresis).turns(); }

  [[nodiscard]] std::vector<Fall> beyond(double hysteresis) const {
    return joined(turning_points(hysteresis).falls(), values_);
  }

 private:
  [[nodiscard]] TurningPoints turning_points(double hysteresis) const {
    TurningPoints turns(hysteresis);
    for (const std::size_t i : turns_) turns.add(i, values_[i]);
    return turns;
  }

  const std::vector<double>& values_;
  std::vector<std::size_t> turns_;
};

/// Falls on either side of which the force rises as quickly are a wave's, where most are sudden; small ones already
/// where it does on one side.
void leave_waves(std::vector<Fall>& falls, const std::vector<double>& values) {
  std::vector<double> rises, own_rates;
  for (std::size_t i = 1; i < falls.size(); ++i) {
    rises.push_back(rate(values, falls[i - 1].trough, falls[i].peak));
    own_rates.push_back(rate(values, falls[i].peak, falls[i].trough));
  }
  if (median(std::move(rises)) > thresholds::kSuddenRate * median(std::move(own_rates))) return;
  std::vector<Fall> sudden;
  const double small = 0.5 * median(drops_of(falls, values));
  for (std::size_t i = 0; i < falls.size(); ++i) {
    const double own = thresholds::kWaveRise * rate(values, falls[i].peak, falls[i].trough);
    const bool before = i > 0 && rate(values, falls[i - 1].trough, falls[i].peak) > own;
    const bool after = i + 1 < falls.size() && rate(values, falls[i].trough, falls[i + 1].peak) > own;
    const bool is_wave = drop_of(falls[i], values) < small ? before || after : before && after;
    if (!is_wave) sudden.push_back(falls[i]);
  }
  falls = std::move(sudden);
}

/// Falls of at least a quarter of the median, seen with a hysteresis to match, none below `least`.
Look look_beyond(const Falls& falls, double hysteresis, double least, const std::vector<double>& values) {
  Look look;
  look.hysteresis = std::max({least, hysteresis});
  look.falls = falls.beyond(look.hysteresis);
  const double quarter = thresholds::kCountedDrop * median(drops_of(look.falls, values));
  std::erase_if(look.falls, [&](const Fall& fall) { return drop_of(fall, values) < quarter; });
  leave_waves(look.falls, values);
  look.drop = median(drops_of(look.falls, values));
  look.asymmetry = asymmetry_of(look.falls);
  return look;
}

constexpr double kAlike = 1.05;  // of two numbers of falls
constexpr double kMostAsymmetry =
    6.0;  // quicker falls than this are not told from each other by sampling and smoothing

/// A single fall has no rise to the next one: it counts where the force took its time to get there.
double score_of(const Look& look, double noise) {
  if (look.falls.empty()) return 0.0;
  const Fall& first = look.falls.front();
  const auto length = static_cast<double>(first.trough - first.peak);
  if (look.falls.size() == 1 && static_cast<double>(first.peak) < thresholds::kLeastAlone * length) return 0.0;
  constexpr double kClear = 40.0;  // beyond, a larger fall is no better seen
  const double stands_out = 1.0 / (1.0 / kClear + noise / look.drop);
  const double asymmetry = look.falls.size() == 1 ? 1.0 : std::min(look.asymmetry, kMostAsymmetry);
  return stands_out * std::sqrt(static_cast<double>(look.falls.size())) * asymmetry;
}

/// What one scale shows best.
struct Scale {
  Smoothed trace;
  double noise = 0.0;
  double floor = 0.0;
  Look best;
};

Scale look_at_scale(Smoothed trace, double noise) {
  Scale scale{std::move(trace), noise, 0.0, {}};
  const std::vector<double>& values = scale.trace.values;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double range = values.empty() ? 0.0 : *high - *low;
  if (!(range > 0.0)) return scale;
  // Noise makes no turning point of 8 standard deviations; rounding errors are no motion.
  scale.floor = std::max(thresholds::kNoiseTurn * noise, 1e-9 * range);
  Falls falls(values, scale.floor);
  const Falls all = falls;
  constexpr double kRatio = 1.5;
  for (double hysteresis = std::max(scale.floor, 1e-3 * range); hysteresis < range; hysteresis *= kRatio) {
    falls.coarsen(hysteresis);
    Look look = look_beyond(falls, hysteresis, scale.floor, values);
    look.score = score_of(look, noise);
    if (look.score > scale.best.score) scale.best = std::move(look);
  }
  // As small a hysteresis as the counted falls allow: it finds each fall's own turning points.
  Look last = look_beyond(all, 0.25 * scale.best.drop, scale.floor, values);
  Look finer = look_beyond(all, 0.25 * last.drop, scale.floor, values);
  const auto count = [](const Look& look) { return static_cast<double>(look.falls.size()); };
  if (count(finer) < kAlike * count(last)) last = std::move(finer);
  last.score = score_of(last, noise);
  const std::size_t noticed = all.beyond(std::max(scale.floor, 0.1 * scale.best.drop)).size();
  last.minor = noticed - std::min(noticed, last.falls.size());
  if (scale.best.drop > 0.0) scale.best = std::move(last);
  return scale;
}

bool shows_the_same(const Look& fine, const Look& best) {
  const auto count = [](const Look& look) { return static_cast<double>(look.falls.size()); };
  return std::abs(count(fine) - count(best)) <= std::max(1.0, (kAlike - 1.0) * count(best)) &&
         std::min(fine.asymmetry, kMostAsymmetry) > 0.8 * std::min(best.asymmetry, kMostAsymmetry);
}

/// One mean a sample, the ends held; the turning points moved to where it turns.
void place_on_samples(const RunningMeans& means, const Scale& scale, Events& events) {
  const Smoothed fine = means.over(scale.trace.width, 1);
  const std::size_t samples = events.trace.size();
  for (std::size_t i = 0; i < samples; ++i) {
    const std::size_t j = i - std::min(i, scale.trace.width / 2);
    events.trace[i] = fine.values[std::min(j, fine.values.size() - 1)];
  }
  const auto at = [&](std::size_t i) { return events.trace.begin() + static_cast<std::ptrdiff_t>(i); };
  const auto around = [&](std::size_t j) {
    const std::size_t i = scale.trace.sample(j);
    return std::pair(at(i - std::min(i, scale.trace.stride)), at(std::min(samples, i + scale.trace.stride + 1)));
  };
  for (const Fall& fall : scale.best.falls) {
    const auto [peak_begin, peak_end] = around(fall.peak);
    const auto [trough_begin, trough_end] = around(fall.trough);
    const auto peak = std::max_element(peak_begin, peak_end);
    const auto trough = std::min_element(std::max(trough_begin, peak + 1), std::max(trough_end, peak + 2));
    events.falls.push_back({static_cast<std::size_t>(peak - at(0)), static_cast<std::size_t>(trough - at(0))});
  }
}

}  // namespace

Events find_events(std::vector<double> force, double noise) {
  const RunningMeans means(force);
  std::vector<Scale> scales;
  std::size_t best = 0;
  for (double width = 1.0; width <= 0.02 * static_cast<double>(force.size()) || width < 2.0; width *= 1.5) {
    const auto samples = static_cast<std::size_t>(std::lround(width));
    Smoothed trace = means.over(samples, std::max<std::size_t>(1, samples / 3));
    if (samples == 1) trace.values = force;  // as it is: sums would round
    const double left = std::max(noise / std::sqrt(width), samples == 1 ? 0.0 : noise_of(trace));
    scales.push_back(look_at_scale(std::move(trace), left));
    if (scales.back().best.score > scales[best].best.score) best = scales.size() - 1;
  }
  std::size_t chosen = 0;
  while (chosen < best && !shows_the_same(scales[chosen].best, scales[best].best)) ++chosen;
  const Scale& scale = scales[chosen];
  Events events;
  events.trace = std::move(force);
  events.width = scale.trace.width;
  events.noise = scale.noise;
  events.hysteresis = scale.best.hysteresis;
  events.asymmetry = scale.best.asymmetry;
  events.minor = scale.best.minor;
  if (scale.trace.width > 1) {
    place_on_samples(means, scale, events);
  } else {
    events.falls = scale.best.falls;
  }
  return events;
}

}  // namespace slipfit::signal
