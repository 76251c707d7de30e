#include "fit/inference/level_trend.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "core/statistics.hpp"
#include "core/thresholds.hpp"
#include "fit/level/level_terms.hpp"
#include "fit/selection/rise.hpp"

namespace slipfit::fit {
namespace {

/// Holds what the cycles show of the level, in the unit of the force.
struct Levels {
  std::vector<double> time_s;
  std::vector<double> fitted;  ///< the polynomial of the model, or one through levels of their own
  std::vector<double> offset;  ///< of the cycle's own level from it
  std::size_t terms = 1;       ///< of the polynomial

  [[nodiscard]] double duration_s() const { return time_s.back() - time_s.front(); }
  /// Mean slope from the first to the last cycle.
  [[nodiscard]] double rate_per_s() const { return (fitted.back() - fitted.front()) / duration_s(); }
  [[nodiscard]] double degrees_of_freedom() const {
    return static_cast<double>(time_s.size()) - static_cast<double>(terms);
  }
};

Levels levels_of(const BlockFit& blocks) {
  Levels levels;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    levels.time_s.push_back(blocks.reference_s(i));
    const double* const local = blocks.parameters.cycles[i].data();
    levels.fitted.push_back(blocks.model(i).level_at(levels.time_s[i], blocks.level_data(), local));
  }
  if (!blocks.level().per_cycle) {
    levels.terms = blocks.level().terms;
    levels.offset = level_offsets(blocks);
    return levels;
  }
  levels.offset = levels.fitted;
  levels.terms = choose_level_terms(levels.time_s, levels.offset);
  levels.fitted = smooth_level(levels.time_s, levels.offset, levels.terms);
  for (std::size_t i = 0; i < blocks.size(); ++i) levels.offset[i] -= levels.fitted[i];
  return levels;
}

/// Returns the standard error of the rate by the scatter s of the n cycles about the fitted level. The coefficient of
/// the Legendre polynomial of order j has the variance (2 j + 1) s^2 / n, and those of odd order differ by 2 between
/// the ends. Where neighbours deviate alike, as with an interference line or a random walk, as many cycles say less:
/// their variance is multiplied by (1 + r) / (1 - r), with their correlation r.
double error_of_rate(const Levels& levels) {
  double square = 0.0, product = 0.0, ends = 0.0;
  for (std::size_t j = 1; j < levels.terms; j += 2) ends += 4.0 * static_cast<double>(2 * j + 1);
  for (std::size_t i = 0; i < levels.time_s.size(); ++i) {
    square += levels.offset[i] * levels.offset[i];
    if (i > 0) product += levels.offset[i] * levels.offset[i - 1];
  }
  if (!(square > 0.0)) return 0.0;
  constexpr double kMostCorrelated = 0.95;  // an estimate from few cycles: the factor stays finite
  const double r = std::clamp(product / square, 0.0, kMostCorrelated);
  const double variance = square / levels.degrees_of_freedom() * (1.0 + r) / (1.0 - r);
  return std::sqrt(variance * ends / static_cast<double>(levels.time_s.size())) / levels.duration_s();
}

/// Extrapolates the level by the parabola through three cycles (Newton's divided differences).
double continued(const Levels& levels, const std::array<std::size_t, 3>& cycles, double time_s) {
  const auto [a, b, c] = cycles;
  const auto slope = [&](std::size_t from, std::size_t to) {
    return (levels.fitted[to] - levels.fitted[from]) / (levels.time_s[to] - levels.time_s[from]);
  };
  const double bend = (slope(b, c) - slope(a, b)) / (levels.time_s[c] - levels.time_s[a]);
  const double past_s = time_s - levels.time_s[a];
  return levels.fitted[a] + past_s * (slope(a, b) + bend * (time_s - levels.time_s[b]));
}

/// Lowest and highest level from the first to the last sample, the run-up before the sliding included, from the mean
/// over the cycles, with a rate that is known to `rate_error_per_s`.
Interval range_of(const Levels& levels, double begin_s, double end_s, double rate_error_per_s) {
  const std::size_t last = levels.time_s.size() - 1;
  const double mean = mean_of(levels.fitted);
  std::vector<double> all = levels.fitted;
  all.push_back(continued(levels, {0, 1, 2}, begin_s));
  all.push_back(continued(levels, {last, last - 1, last - 2}, end_s));
  const auto [low, high] = std::minmax_element(all.begin(), all.end());
  const double error = 0.5 * (end_s - begin_s) * rate_error_per_s;
  return {*low - mean - error, *high - mean + error};
}

/// Share of a trend that the measured load explains where friction is proportional to the load; 0 without one.
double share_by_load(const Recording& recording, double rate_per_s) {
  const std::span<const double> load_N = recording.normal_force_N();
  if (load_N.size() < 2) return 0.0;
  const double mean_load_N = mean_of(load_N);
  if (!(mean_load_N > 0.0)) return 0.0;
  const double load_rate = line_sums(recording.time_s(), load_N).slope();
  return std::clamp(mean_of(recording.force()) / mean_load_N * load_rate / rate_per_s, 0.0, 1.0);
}

/// Returns the least and the largest share of a trend that may be a change of the friction.
Interval possible_shares(const Recording& recording, const std::optional<RampDrift>& drift, double rate_per_s) {
  const LevelReading stated = recording.conditions().drift;
  if (stated == LevelReading::Sensor) return {0.0, 0.0};
  if (stated == LevelReading::Friction) return {1.0, 1.0};
  if (drift) {
    const auto excludes = [&](double share) {
      return std::abs(drift->share - share) > thresholds::kSureSigmas * drift->standard_error;
    };
    if (excludes(1.0) && !excludes(0.0)) return {1.0, 1.0};
    if (excludes(0.0) && !excludes(1.0)) return {0.0, 0.0};
  }
  const double by_load = share_by_load(recording, rate_per_s);
  return {by_load > 1.0 - thresholds::kLoadShare ? 1.0 : by_load, 1.0};
}

Coordinates move_of(const TrendFindings& trend, double log_k) {
  Coordinates move = log_k * Coordinates::Unit(kLogStiffness);
  if (trend.mass_is_stated) move(kLogFrequency) = 0.5 * log_k;
  return move;
}

}  // namespace

TrendFindings find_level_trend(const Recording& recording, const DampedFit& fit) {
  const BlockFit& blocks = fit.blocks;
  TrendFindings result;
  result.mass_is_stated = fit.mass_gives_frequency;
  result.is_per_cycle = blocks.level().per_cycle;
  if (blocks.size() < thresholds::kFewestSlips) return result;
  const Levels levels = levels_of(blocks);
  const double freedom = levels.degrees_of_freedom();
  if (levels.terms < 2 || !(freedom > 0.0)) return result;
  const double rate = levels.rate_per_s();
  const double error = error_of_rate(levels);
  result.trend.rate_per_s = symmetric(rate, error, freedom);
  // The fit with a level of its own in every cycle takes the slope of a stick for k V, the one with a polynomial takes
  // the slope of that off.
  const double fitted_share = result.is_per_cycle ? 1.0 : 0.0;
  result.trend.in_sticks_per_s = (1.0 - fitted_share) * rate;
  result.is_significant = std::abs(rate) > thresholds::kSureSigmas * error;
  if (!result.is_significant || recording.conditions().drift == LevelReading::None) return result;
  const Interval whole{recording.whole_begin_s(), recording.time_s().back()};
  result.trend.level_range = range_of(levels, whole.low, whole.high, t_quantile(freedom) * error);
  const std::optional<RampDrift> in_ramps = drift_in_ramps(blocks);
  const Interval shares = possible_shares(recording, in_ramps, rate);
  if (shares.low == shares.high)
    result.trend.reading = shares.low > 0.5 ? LevelReading::Friction : LevelReading::Sensor;
  const double reported = result.is_per_cycle ? shares.high : shares.low;
  const double other = result.is_per_cycle ? shares.low : shares.high;
  const double rate_in_sticks = in_ramps ? in_ramps->level_rate : rate;
  result.trend.in_sticks_per_s = (1.0 - reported) * rate_in_sticks;
  const double stiffness = std::exp(blocks.parameters.values(kLogStiffness));
  const double drift = rate_in_sticks / (stiffness * recording.conditions().speed_m_per_s);
  const auto log_k_at = [&](double share) {
    return std::log(std::max(thresholds::kNegligible, 1.0 + (share - fitted_share) * drift));
  };
  if (fit.held[kLogStiffness]) return result;  // by the user
  result.log_k_to_value = log_k_at(reported);
  result.log_k_to_other = log_k_at(other) - result.log_k_to_value;
  return result;
}

TrendFindings trend_of_sweep(std::span<const SweepRecording> recordings, const SweepData& data, const Held& held) {
  TrendFindings all;
  all.mass_is_stated = data.mass.has_value();
  double weights = 0.0;
  Interval range;
  bool has_trend = false;
  for (const std::size_t i : data.fitted) {
    const TrendFindings one = find_level_trend(recordings[i].recording, *data.single[i]);
    const double variance = data.single[i]->uncertainty.covariance(kLogStiffness, kLogStiffness);
    if (!(variance > 0.0)) continue;
    weights += 1.0 / variance;
    all.log_k_to_value += one.log_k_to_value / variance;
    all.log_k_to_other += one.log_k_to_other / variance;
    if (!one.trend.level_range) continue;
    has_trend = true;
    range = {std::min(range.low, one.trend.level_range->low / data.loads[i]),
             std::max(range.high, one.trend.level_range->high / data.loads[i])};
  }
  if (has_trend) all.trend.level_range = range;
  if (held[kLogStiffness] || !(weights > 0.0)) weights = std::numeric_limits<double>::infinity();
  all.log_k_to_value /= weights;
  all.log_k_to_other /= weights;
  return all;
}

Coordinates with_trend(const Coordinates& values, const TrendFindings& trend) {
  return values + move_of(trend, trend.log_k_to_value);
}

Spread with_trend(Spread spread, const TrendFindings& trend, double force_unit) {
  if (trend.log_k_to_other != 0.0) spread.to_rivals.push_back(move_of(trend, trend.log_k_to_other));
  if (!trend.trend.level_range) return spread;
  for (const double end : {trend.trend.level_range->low, trend.trend.level_range->high}) {
    spread.to_rivals.emplace_back(end / force_unit * Coordinates::Unit(kLevel));
  }
  return spread;
}

}  // namespace slipfit::fit
