#include "fit/inference/level_trend.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/fit_thresholds.hpp"
#include "core/line_sums.hpp"
#include "core/quantile.hpp"
#include "core/student.hpp"
#include "fit/selection/ramps.hpp"

namespace slipfit::fit {
namespace {

/// Rise of the level per second with its standard error, in the unit of the force.
struct Rate {
  double value = 0.0;
  double standard_error = 0.0;
};

/// Of a level polynomial the mean rate from its first to its last cycle, which is what the mean stick contains of a
/// drift; of levels of their own that of the line through them.
Rate rate_of(const DampedFit& fit) {
  const BlockFit& blocks = fit.blocks;
  const double force = blocks.scales().force;
  if (!blocks.level().per_cycle) {
    const double variance = fit.uncertainty.covariance(kLevelRate, kLevelRate);
    return {force * coordinates_of(blocks)(kLevelRate), force * std::sqrt(std::max(0.0, variance))};
  }
  const LineSums line = line_sums(
      blocks.size(), [&](std::size_t i) { return blocks.reference_s(i); },
      [&](std::size_t i) { return blocks.parameters.cycles[i][2] * force; });
  return {line.slope(), line.slope_error()};
}

/// Lowest and highest level from the first to the last sample, the run-up before the sliding included, from the mean
/// over the cycles. Before the first and behind the last cycle a polynomial goes on as a line.
Interval range_of_level(const Recording& recording, const BlockFit& blocks, double rate) {
  std::vector<double> levels;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const double time_s = blocks.reference_s(i);
    levels.push_back(blocks.level().per_cycle
                         ? rate * time_s
                         : blocks.model(i).level_at(time_s, blocks.level_data(), blocks.parameters.cycles[i].data()));
  }
  const std::size_t last = blocks.size() - 1;
  const auto slope = [&](std::size_t from, std::size_t to) {
    return (levels[to] - levels[from]) / (blocks.reference_s(to) - blocks.reference_s(from));
  };
  const double mean = mean_of(levels);
  levels.push_back(levels[0] + slope(0, 1) * (recording.whole_begin_s() - blocks.reference_s(0)));
  levels.push_back(levels[last] + slope(last - 1, last) * (recording.time_s().back() - blocks.reference_s(last)));
  const auto [low, high] = std::minmax_element(levels.begin(), levels.end());
  return {*low - mean, *high - mean};
}

/// Share of a trend that the measured load explains where friction is proportional to the load; empty without one.
std::optional<double> share_by_load(const Recording& recording, double rate) {
  const std::span<const double> load_N = recording.normal_force_N();
  if (load_N.size() < 2) return std::nullopt;
  const double mean_load_N = mean_of(load_N);
  if (!(mean_load_N > 0.0)) return std::nullopt;
  const double load_rate = line_sums(recording.time_s(), load_N).slope();
  return std::clamp(mean_of(recording.force()) / mean_load_N * load_rate / rate, 0.0, 1.0);
}

/// Which share of a trend may be a change of the friction, from the least to the most.
Interval possible_shares(const Recording& recording, const std::optional<RampDrift>& drift, double rate) {
  switch (recording.conditions().drift) {
    case LevelReading::Sensor:
      return {0.0, 0.0};
    case LevelReading::Friction:
    case LevelReading::None:
      return {1.0, 1.0};
    case LevelReading::Open:
      break;
  }
  if (drift) {
    const auto excludes = [&](double share) {
      return std::abs(drift->share - share) > thresholds::kTrendSigmas * drift->standard_error;
    };
    if (excludes(1.0) && !excludes(0.0)) return {1.0, 1.0};
    if (excludes(0.0) && !excludes(1.0)) return {0.0, 0.0};
  }
  const double by_load = share_by_load(recording, rate).value_or(0.0);
  return {by_load > 1.0 - thresholds::kLoadShare ? 1.0 : by_load, 1.0};
}

LevelReading reading_of(const Interval& shares) {
  if (shares.low < shares.high) return LevelReading::Open;
  return shares.low > 0.5 ? LevelReading::Friction : LevelReading::Sensor;
}

}  // namespace

TrendFindings find_level_trend(const Recording& recording, const DampedFit& fit) {
  const BlockFit& blocks = fit.blocks;
  TrendFindings result;
  const Rate rate = rate_of(fit);
  if (blocks.size() < thresholds::kFewestFitted || !(rate.standard_error > 0.0)) return result;
  const auto freedom = blocks.level().per_cycle ? static_cast<double>(blocks.size()) - 2.0
                                                : std::max(1.0, fit.uncertainty.degrees_of_freedom);
  result.trend.rate_per_s = symmetric(rate.value, rate.standard_error, freedom);
  // The fit with a level of its own in every cycle takes the rise of a stick for k V, the one with a polynomial takes
  // what the polynomial rises off.
  const double fitted_share = blocks.level().per_cycle ? 1.0 : 0.0;
  result.trend.in_sticks_per_s = (1.0 - fitted_share) * rate.value;
  result.is_significant = std::abs(rate.value) > thresholds::kTrendSigmas * rate.standard_error;
  if (recording.conditions().drift == LevelReading::None || !result.is_significant) return result;
  result.is_per_cycle = blocks.level().per_cycle;
  result.trend.level_range = range_of_level(recording, blocks, rate.value);
  const std::optional<RampDrift> in_ramps = drift_in_ramps(blocks);
  const Interval shares = possible_shares(recording, in_ramps, rate.value);
  result.trend.reading = reading_of(shares);
  const double reported_share = blocks.level().per_cycle ? shares.high : shares.low;
  const double other_share = blocks.level().per_cycle ? shares.low : shares.high;
  const double stiffness = std::exp(blocks.parameters.globals[kLogStiffness]);
  const double rate_in_sticks = in_ramps ? in_ramps->level_rate : rate.value;
  result.trend.in_sticks_per_s = (1.0 - reported_share) * rate_in_sticks;
  const double drift = rate_in_sticks / (stiffness * recording.conditions().speed_m_per_s);
  const auto log_k_at = [&](double share) {
    return std::log(std::max(thresholds::kLeastStiffness, 1.0 + (share - fitted_share) * drift));
  };
  result.log_k_to_value = log_k_at(reported_share);
  result.log_k_to_other = log_k_at(other_share) - result.log_k_to_value;
  return result;
}

TrendFindings trend_of_sweep(std::span<const SweepRecording> recordings, const SweepData& data, const Held& held) {
  TrendFindings all;
  double weights = 0.0;
  Interval range;
  for (const std::size_t i : data.fitted) {
    const TrendFindings one = find_level_trend(recordings[i].recording, *data.single[i]);
    const double variance = data.single[i]->uncertainty.covariance(kLogStiffness, kLogStiffness);
    if (!(variance > 0.0)) continue;
    weights += 1.0 / variance;
    all.log_k_to_value += one.log_k_to_value / variance;
    all.log_k_to_other += one.log_k_to_other / variance;
    if (!one.trend.level_range) continue;
    all.is_significant = true;
    range = {std::min(range.low, one.trend.level_range->low / data.loads[i]),
             std::max(range.high, one.trend.level_range->high / data.loads[i])};
  }
  if (all.is_significant) all.trend.level_range = range;
  if (held[kLogStiffness] || !(weights > 0.0)) weights = std::numeric_limits<double>::infinity();
  all.log_k_to_value /= weights;
  all.log_k_to_other /= weights;
  return all;
}

Coordinates with_trend(Coordinates values, const TrendFindings& trend) {
  values(kLogStiffness) += trend.log_k_to_value;
  return values;
}

Spread with_trend(Spread spread, const TrendFindings& trend, double force_unit) {
  if (trend.log_k_to_other != 0.0) {
    spread.to_rivals.emplace_back(trend.log_k_to_other * Coordinates::Unit(kLogStiffness));
  }
  if (!trend.trend.level_range) return spread;
  for (const double end : {trend.trend.level_range->low, trend.trend.level_range->high}) {
    spread.to_rivals.emplace_back(end / force_unit * Coordinates::Unit(kLevel));
  }
  return spread;
}

}  // namespace slipfit::fit
