#include "fit/cycle/start.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

#include "core/thresholds.hpp"
#include "fit/level/level_terms.hpp"
#include "model/rebound.hpp"
#include "signal/least_squares.hpp"
#include "signal/smoothing.hpp"

namespace slipfit::fit {

namespace {

/// Half period from the 80 % to 20 % falls: a half cosine passes them in acos(-0.6) - acos(0.6) of its pi.
double half_period_of(const Segmentation& segmentation) {
  std::vector<double> falls;
  for (const DetectedSlip& slip : segmentation.slips) falls.push_back(slip.fall_s);
  const double share = (std::acos(-0.6) - std::acos(0.6)) / std::numbers::pi;
  return signal::median(falls) / share;
}

/// Least-squares coefficients of the level polynomial through one value a slip.
std::vector<double> level_through(const BlockFit& fit, const std::vector<double>& times_s,
                                  const std::vector<double>& levels) {
  const std::size_t terms = fit.level().terms;
  const Scales& scales = fit.scales();
  const Eigen::MatrixXd basis = legendre_basis(times_s, scales.time_begin_s, scales.time_end_s, terms);
  const Eigen::Map<const Eigen::ArrayXd> values(levels.data(), static_cast<Eigen::Index>(levels.size()));
  const Eigen::VectorXd target = (values - scales.level) / scales.force;
  const Eigen::VectorXd solution = signal::least_squares(basis, target);
  std::vector<double> coefficients(fit.level().columns(), 0.0);  // no hum to start with
  std::copy_n(solution.data(), terms, coefficients.begin());
  return coefficients;
}

/// Returns the slope of the line through the middle of a rise. This is stick wherever the rise has any, and otherwise
/// the steepest part of the rise. The slope is empty where the middle has one sample.
std::optional<double> slope_in_middle(const Recording& recording, const DetectedSlip& before,
                                      const DetectedSlip& after) {
  const auto time_s = recording.time_s();
  const auto force = recording.force();
  const auto share = [&](double x) {
    return before.trough + static_cast<std::size_t>(x * static_cast<double>(after.peak - before.trough));
  };
  const std::size_t begin = share(0.3);
  const std::size_t end = share(0.7) + 1;
  const auto count = static_cast<double>(end - begin);
  if (count < 2.0) return std::nullopt;
  double mean_s = 0.0;
  double cross = 0.0;
  double spread = 0.0;
  for (std::size_t j = begin; j < end; ++j) mean_s += (time_s[j] - time_s[begin]) / count;
  for (std::size_t j = begin; j < end; ++j) {
    const double dt = time_s[j] - time_s[begin] - mean_s;
    cross += dt * (force[j] - force[begin]);
    spread += dt * dt;
  }
  return spread > 0.0 ? std::optional(cross / spread) : std::nullopt;
}

/// Returns the slope from trough to peak, which were found without the mains: samples between them still contain it. It
/// is empty where they are one sample.
std::optional<double> slope_of_whole(const Recording& recording, const DetectedSlip& before,
                                     const DetectedSlip& after) {
  const double duration_s = recording.time_s()[after.peak] - recording.time_s()[before.trough];
  return duration_s > 0.0 ? std::optional((after.peak_force - before.trough_force) / duration_s) : std::nullopt;
}

}  // namespace

Scales scales_of(const Recording& recording, const Quality& quality, const Segmentation& segmentation) {
  Scales scales;
  scales.speed_m_per_s = recording.conditions().speed_m_per_s;
  scales.view = recording.conditions().force_view;
  scales.sensor_lag_s = recording.conditions().sensor_lag_s().value_or(0.0);
  scales.sensor_order = recording.conditions().sensor_filter_order;
  scales.sensor_average_s = recording.conditions().sensor_average_s.value_or(0.0);
  scales.half_period_s = std::max(half_period_of(segmentation), 1e-3 * recording.sample_interval_s());
  scales.sensor_time_unit_s = scales.half_period_s;
  std::vector<double> drops;
  std::vector<double> middles;
  for (const DetectedSlip& slip : segmentation.slips) {
    drops.push_back(slip.drop());
    middles.push_back(0.5 * (slip.peak_force + slip.trough_force));
  }
  scales.force = 0.5 * signal::median(drops);
  scales.level = signal::median(middles);
  // A recording without noise still has rounding; residuals must keep a finite weight.
  scales.noise = std::max({quality.noise_rms, 0.29 * quality.quantisation_step.value_or(0.0), 1e-6 * scales.force});
  return scales;
}

double stiffness_of(const Recording& recording, const Segmentation& segmentation) {
  std::vector<double> slopes;
  for (std::size_t i = 1; i < segmentation.slips.size(); ++i) {
    const DetectedSlip& before = segmentation.slips[i - 1];
    const DetectedSlip& after = segmentation.slips[i];
    const std::optional<double> slope = segmentation.mains_Hz.empty() ? slope_in_middle(recording, before, after)
                                                                      : slope_of_whole(recording, before, after);
    if (slope) slopes.push_back(*slope);
  }
  return signal::median(slopes) / recording.conditions().speed_m_per_s;
}

void set_start(BlockFit& fit, const Segmentation& segmentation, const Coordinates& start) {
  const Scales& scales = fit.scales();
  const double stiffness_N_per_m = std::exp(start(kLogStiffness));
  const double omega_rad_per_s = std::exp(start(kLogFrequency));
  const double zeta = start(kDamping);
  const double b = std::sqrt(1.0 - zeta * zeta);
  const double rebound = model::rebound_at(zeta);
  const double u = stiffness_N_per_m * scales.speed_m_per_s / omega_rad_per_s;
  fit.start_at(start);
  std::vector<double> times_s;
  std::vector<double> levels;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    const DetectedSlip& slip = segmentation.slips[fit.data(i).slip];
    const double peak = slip.drop() / (1.0 + rebound);
    levels.push_back(slip.trough_force + peak * rebound);
    times_s.push_back(slip.middle_s);
    // Undamped: the force peaks at sqrt(A^2 + u^2), atan(u / A) after the onset.
    const double onset_force = std::sqrt(std::max(peak * peak - u * u, 0.09 * peak * peak));
    const double half_period_s = std::numbers::pi / (omega_rad_per_s * b);
    const double onset_s =
        slip.middle_s - 0.5 * half_period_s - std::atan2(u, onset_force) / omega_rad_per_s - scales.sensor_lag_s;
    fit.parameters.cycles[i] = {(onset_s - fit.reference_s(i)) / scales.half_period_s, onset_force / scales.force,
                                (levels.back() - scales.level) / scales.force};
  }
  if (fit.level().terms > 0) fit.parameters.level = level_through(fit, times_s, levels);
}

namespace {

/// Returns the variance of the samples about straight sticks.
double stick_variance(const BlockFit& fit) {
  double scatter = 0.0;
  double freedom = 0.0;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    for (const auto* bins : {&fit.data(i).bins_before, &fit.data(i).bins_after}) {
      for (const StickBin& bin : *bins) {
        scatter += bin.scatter;
        freedom += std::max(0.0, bin.count - 2.0);
      }
    }
  }
  return freedom > 0.0 ? scatter / freedom : fit.scales().noise * fit.scales().noise;
}

struct Slopes {
  std::vector<double> residual;  ///< unit of force
  std::vector<double> slope;     ///< of the model, unit of force a second
};

/// Returns the residuals and slopes of the samples around one slip. The derivative with respect to the onset is minus
/// that of the force with respect to time.
Slopes slopes_of(const BlockFit& fit, std::size_t cycle) {
  const CycleModel& model = fit.model(cycle);
  std::vector<double> residuals(model.residuals());
  std::vector<double> jacobian(model.residuals() * model.columns().size());
  model.evaluate(fit.values(cycle), residuals.data(), jacobian.data());
  const std::size_t onset = model.columns().common();
  Slopes result;
  const CycleData& data = fit.data(cycle);
  for (std::size_t j = 0; j < data.time_s.size(); ++j) {
    const double unit = fit.scales().noise / (data.weight.empty() ? 1.0 : data.weight[j]);
    result.residual.push_back(residuals[j] * unit);
    result.slope.push_back(jacobian[onset * model.residuals() + j] * unit / fit.scales().half_period_s);
  }
  return result;
}

}  // namespace

std::vector<CycleData> weigh_by_slope(const BlockFit& fit) {
  const double noise2 = stick_variance(fit);
  const double rate = std::exp(fit.parameters.values(0)) * fit.scales().speed_m_per_s;
  std::vector<Slopes> slopes;
  double excess = 0.0;
  double weight = 0.0;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    slopes.push_back(slopes_of(fit, i));
    for (std::size_t j = 0; j < slopes[i].slope.size(); ++j) {
      const double steeper2 = std::max(0.0, slopes[i].slope[j] * slopes[i].slope[j] - rate * rate);
      excess += steeper2 * (slopes[i].residual[j] * slopes[i].residual[j] - noise2);
      weight += steeper2 * steeper2;
    }
  }
  const double time_variance = weight > 0.0 ? std::max(0.0, excess / weight) : 0.0;
  std::vector<CycleData> cycles;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    cycles.push_back(fit.data(i));
    cycles[i].weight.clear();
    for (const double slope : slopes[i].slope) {
      const double more = time_variance * std::max(0.0, slope * slope - rate * rate);
      cycles[i].weight.push_back(std::sqrt(noise2 / (noise2 + more)));
    }
  }
  return cycles;
}

double half_width_s(double stiffness_N_per_m, const Scales& scales) {
  const double u = stiffness_N_per_m * scales.speed_m_per_s * scales.half_period_s / std::numbers::pi;
  return scales.half_period_s * (1.0 - std::atan2(scales.force, u) / std::numbers::pi + 0.3) +
         shown_beyond_s({scales.sensor_lag_s, scales.sensor_average_s});
}

LevelModel first_level(const Recording& recording, const Segmentation& segmentation,
                       const std::vector<CycleData>& cycles, const Scales& scales) {
  std::vector<double> middles;
  std::vector<double> drops;
  for (const CycleData& cycle : cycles) {
    const DetectedSlip& slip = segmentation.slips[cycle.slip];
    middles.push_back(0.5 * (slip.peak_force + slip.trough_force));
    drops.push_back(slip.drop());
  }
  const std::vector<double> times_s = middles_s(segmentation, cycles);
  const std::size_t terms = choose_level_terms(times_s, middles);
  const double left = unexplained_level(times_s, middles, drops, terms);
  const bool well_sampled = scales.half_period_s > thresholds::kWellSampled * recording.sample_interval_s();
  const bool wanders = well_sampled && left > thresholds::kWanderingShare * 2.0 * scales.force &&
                       left > thresholds::kWanderingNoises * scales.noise && cycles.size() >= kFewestWandering;
  return {wanders, wanders ? 0 : terms, segmentation.mains_Hz};
}

std::vector<double> middles_s(const Segmentation& segmentation, const std::vector<CycleData>& cycles) {
  std::vector<double> values;
  values.reserve(cycles.size());
  for (const CycleData& cycle : cycles) values.push_back(segmentation.slips[cycle.slip].middle_s);
  return values;
}

std::vector<Coordinates> first_values(double stiffness_N_per_m, const HeldParameters& held, const Scales& scales,
                                      double step_s) {
  std::vector<double> stretches{1.0};
  if (scales.half_period_s < 6.0 * step_s) stretches = {1.0, 1.6, 1.0 / 0.6};
  // Lag and averaging draw the fall out.
  const double smoothed_s = std::max(scales.sensor_lag_s, 0.3 * scales.sensor_average_s);
  if (smoothed_s > 0.05 * scales.half_period_s) stretches = {1.0, 1.4, 2.0};
  const double zeta = held.damping_ratio.value_or(0.05);
  std::vector<Coordinates> starts;
  for (const double stretch : stretches) {
    const double omega = held.natural_frequency_rad_per_s.value_or(
        stretch * std::numbers::pi / (scales.half_period_s * std::sqrt(1.0 - zeta * zeta)));
    starts.push_back(oscillator(std::log(stiffness_N_per_m), std::log(omega), zeta));
  }
  return starts;
}

}  // namespace slipfit::fit
