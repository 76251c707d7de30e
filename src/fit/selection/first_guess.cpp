#include "fit/selection/first_guess.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/fit_thresholds.hpp"
#include "fit/level/level_order.hpp"

namespace slipfit::fit {

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
