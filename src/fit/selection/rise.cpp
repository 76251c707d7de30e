#include "fit/selection/rise.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "core/statistics.hpp"
#include "core/thresholds.hpp"
#include "fit/problem/solve.hpp"
#include "fit/selection/finish.hpp"
#include "fit/selection/tiers.hpp"

namespace slipfit::fit {

double level_slope(const BlockFit& fit, std::size_t cycle, double time_s) {
  const double step_s = fit.scales().half_period_s;
  const double* local = fit.parameters.cycles[cycle].data();
  const auto level = [&](double t_s) { return fit.model(cycle).level_at(t_s, fit.level_data(), local); };
  return (level(time_s + step_s) - level(time_s - step_s)) / (2.0 * step_s);
}

namespace {

/// Merges centred sums (parallel axis rule): the same as reducing all samples at once.
StickBin merge(const std::vector<StickBin>& bins) {
  StickBin all;
  for (const StickBin& bin : bins) {
    all.count += bin.count;
    all.time_s += bin.count * bin.time_s;
    all.force += bin.count * bin.force;
  }
  if (all.count == 0.0) return all;
  all.time_s /= all.count;
  all.force /= all.count;
  double cross = 0.0;
  double square = 0.0;
  for (const StickBin& bin : bins) {
    const double dt = bin.time_s - all.time_s;
    const double df = bin.force - all.force;
    all.time_spread += bin.time_spread + bin.count * dt * dt;
    cross += bin.slope * bin.time_spread + bin.count * dt * df;
    square += bin.scatter + bin.slope * bin.slope * bin.time_spread + bin.count * df * df;
  }
  if (all.time_spread > 0.0) all.slope = cross / all.time_spread;
  all.scatter = std::max(0.0, square - all.slope * cross);
  return all;
}

/// Returns the bins of a cycle without hum and without what bends the sticks in the model.
std::vector<StickBin> straightened(std::vector<StickBin> bins, const BlockFit& fit, std::size_t cycle) {
  const double* const waves = fit.wave_data();
  for (StickBin& bin : bins) {
    for (std::size_t i = 0; i < bin.lines.size(); ++i) {
      const LineInBin& line = bin.lines[i];
      for (std::size_t j = 0; j < 2; ++j) {
        bin.force -= fit.scales().force * waves[2 * i + j] * line.mean[j];
        bin.slope -= fit.scales().force * waves[2 * i + j] * line.slope[j];
      }
    }
  }
  const StickBend bend = fit.model(cycle).bend(fit.parameters.values);
  for (StickBin& bin : bins) {
    const StickBend::Line line = bend.over(bin);
    bin.force -= line.mean;
    bin.slope -= line.slope;
  }
  return bins;
}

/// Returns whether both parts of a stick have samples enough for a slope.
bool have_slopes(const StickBin& early, const StickBin& late) {
  constexpr double kFewest = 2.0;
  return early.count >= kFewest && late.count >= kFewest;
}

/// Two parts of a stick, the earlier first, without hum and without the rise after a slip.
struct Parts {
  StickBin early;
  StickBin late;
};

/// Each cycle's difference of slopes, weighted by what its parts know: slopes have the variance noise^2 / time_spread.
template <class PartsOf>
std::optional<RampBend> bend_between(const BlockFit& fit, const PartsOf& parts_of) {
  double weights = 0.0;
  double difference = 0.0;
  double slope = 0.0;
  std::vector<std::pair<double, double>> cycles;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    auto [early, late] = parts_of(i);
    if (!have_slopes(early, late)) continue;
    late.slope -= level_slope(fit, i, late.time_s);
    early.slope -= level_slope(fit, i, early.time_s);
    const double weight = 1.0 / (1.0 / late.time_spread + 1.0 / early.time_spread);
    cycles.emplace_back(weight, early.slope - late.slope);
    weights += weight;
    difference += weight * (early.slope - late.slope);
    slope += weight * 0.5 * (early.slope + late.slope);
  }
  if (cycles.size() < 5 || !(slope > 0.0)) return std::nullopt;
  difference /= weights;
  slope /= weights;
  double variance = 0.0;
  for (const auto& [weight, value] : cycles) variance += weight * weight * (value - difference) * (value - difference);
  const double clear =
      t_quantile(static_cast<double>(cycles.size()) - 1.0, 1.0 - normal_above(thresholds::kClearSigmas));
  const double standard_error = std::sqrt(variance) / weights / slope;
  return RampBend{difference / slope, clear / thresholds::kClearSigmas * standard_error};
}

}  // namespace

std::optional<RampBend> ramp_bend(const BlockFit& fit) {
  return bend_between(fit, [&](std::size_t i) {
    return Parts{merge(straightened(fit.data(i).bins_after, fit, i)),
                 merge(straightened(fit.data(i).bins_before, fit, i))};
  });
}

std::optional<RampBend> late_bend(const BlockFit& fit) {
  return bend_between(fit, [&](std::size_t i) {
    const std::vector<StickBin> bins = straightened(fit.data(i).bins_before, fit, i);
    const auto middle = bins.begin() + std::ssize(bins) / 2;
    return Parts{merge({bins.begin(), middle}), merge({middle, bins.end()})};
  });
}

std::vector<double> level_offsets(const BlockFit& fit) {
  std::vector<double> offsets;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    const CycleState state = fit.state(i);
    const double* const local = fit.parameters.cycles[i].data();
    double sum = 0.0;
    double count = 0.0;
    for (const auto* bins : {&fit.data(i).bins_before, &fit.data(i).bins_after}) {
      const StickBin ramp = merge(straightened(*bins, fit, i));
      if (ramp.count == 0.0) continue;
      const double level = fit.model(i).level_at(ramp.time_s, fit.level_data(), local);
      sum += ramp.force - level - state.force_at(ramp.time_s);
      count += 1.0;
    }
    offsets.push_back(count > 0.0 ? sum / count : 0.0);
  }
  return offsets;
}

std::optional<RampDrift> drift_in_ramps(const BlockFit& fit) {
  if (fit.level().per_cycle || fit.level().terms < 3) return std::nullopt;
  std::vector<double> measured, level, weight;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    const StickBin late = merge(straightened(fit.data(i).bins_before, fit, i));
    const StickBin early = merge(straightened(fit.data(i).bins_after, fit, i));
    if (!have_slopes(early, late)) continue;
    weight.push_back(late.time_spread + early.time_spread);
    const auto mean = [&](double of_late, double of_early) {
      return (late.time_spread * of_late + early.time_spread * of_early) / weight.back();
    };
    const CycleState state = fit.state(i);
    measured.push_back(mean(late.slope, early.slope) - state.force_scale * state.omega_rad_per_s);
    level.push_back(mean(level_slope(fit, i, late.time_s), level_slope(fit, i, early.time_s)));
  }
  if (measured.size() < 5) return std::nullopt;
  const LineSums line = weighted_line_sums(level, measured, weight);
  if (!(line.square > 0.0)) return std::nullopt;
  return RampDrift{line.slope(), line.slope_error(), line.mean_x};
}

namespace {

constexpr int kMostRounds = 10;
constexpr double kSmallLengthChange = 0.2;  // of ln l, in standard errors

/// `rise` after slips that begin and end where `fit` has them. A slip that has no solution there stays where it was.
RiseAfterSlip moved(RiseAfterSlip rise, const BlockFit& fit) {
  for (std::size_t i = 0; i < fit.size(); ++i) {
    const std::optional<CycleState> state = fit.model(i).state(fit.parameters.values, fit.parameters.cycles[i].data());
    if (!state) continue;
    rise.slip_begin_s[fit.data(i).slip] = state->onset_s;
    rise.slip_end_s[fit.data(i).slip] = state->onset_s + state->slip_s();
  }
  return rise;
}

/// The same cycles at the same parameters, with a rise after these slips.
BlockFit with_slips(const BlockFit& fit, RiseAfterSlip rise) {
  LevelModel level = fit.level();
  level.reloading = std::make_shared<const RiseAfterSlip>(std::move(rise));
  BlockFit other = fit.with_level(std::move(level), fit.scales());
  other.parameters = fit.parameters;
  return other;
}

/// Returns the fit with a free length of the rise, which comes after the slips as `fit` has them.
std::optional<DampedFit> with_free_length(const Quality& quality, DampedFit fit) {
  RiseAfterSlip rise = moved(*fit.blocks.level().reloading, fit.blocks);
  rise.is_free = true;
  fit.blocks = with_slips(fit.blocks, std::move(rise));
  if (!std::isfinite(solve(fit.blocks, {fit.held, false}))) return std::nullopt;
  return with_uncertainty(std::move(fit), quality);
}

}  // namespace

double rise_length_m(const DampedFit& fit) {
  return std::exp(fit.blocks.parameters.values(kReloadLength));
}

BlockFit with_rise_after(const BlockFit& fit) {
  if (!fit.level().reloading) return fit;
  return with_slips(fit, moved(*fit.level().reloading, fit));
}

bool rises(const BlockFit& fit) {
  return !fit.level().reloading || fit.parameters.values(kReloadForce) > 0.0;
}

BlockFit with_rise_over(double length_m, const FitInput& input, const BlockFit& slips, const BlockFit& fit) {
  const double speed = fit.scales().speed_m_per_s;
  RiseAfterSlip rise{length_m, kLongestRise * speed * median_stick_s(slips), false, speed, {}, {}};
  for (const DetectedSlip& slip : input.segmentation.slips) {
    rise.slip_begin_s.push_back(input.recording.time_s()[slip.peak]);
    rise.slip_end_s.push_back(input.recording.time_s()[slip.trough]);
  }
  BlockFit risen = with_slips(fit, moved(std::move(rise), slips));
  risen.parameters.values(kReloadLength) = std::log(length_m);
  return risen;
}

BlockFit with_free_rise(const BlockFit& fit) {
  if (!fit.level().reloading) return fit;
  RiseAfterSlip rise = *fit.level().reloading;
  rise.is_free = true;
  return with_slips(fit, std::move(rise));
}

std::optional<DampedFit> settle_rise(const FitInput& input, std::optional<DampedFit> fit) {
  if (!fit || !fit->blocks.level().reloading || !fit->blocks.level().reloading->is_free) return fit;
  const double step_m = fit->blocks.scales().speed_m_per_s * input.recording.sample_interval_s();
  for (int round = 0; fit && round < kMostRounds; ++round) {
    const double before_m = rise_length_m(*fit);
    if (!rises(fit->blocks) || !(before_m >= step_m)) return std::nullopt;
    fit = with_free_length(input.quality, *std::move(fit));
    if (!fit) return fit;
    const double change = std::abs(std::log(rise_length_m(*fit) / before_m));
    if (change < kSmallLengthChange * error_of(*fit, kReloadLength)) return fit;
  }
  return std::nullopt;
}

std::optional<DampedFit> finish_settled(const FitInput& input, DampedFit fit) {
  std::optional<DampedFit> next = settle_rise(input, with_uncertainty(std::move(fit), input.quality));
  return next ? finish_fit(input, *std::move(next)) : std::nullopt;
}

}  // namespace slipfit::fit
