#include "slipfit/fit/result.hpp"

#include <algorithm>
#include <cmath>

#include "core/fit_thresholds.hpp"

namespace slipfit {

namespace {

/// ln of the ratio to the nearer end of the speeds; below 0 among them.
double from_end(const SpeedReach& reach, double speed_m_per_s) {
  return std::max(std::log(speed_m_per_s / reach.fastest_m_per_s), std::log(reach.slowest_m_per_s / speed_m_per_s));
}

}  // namespace

std::array<double, kModelValues> values_of(const ModelEstimate& model) {
  const SpeedDependence law = model.speed_dependence.value_or(SpeedDependence{});
  const Ageing ageing = model.ageing.value_or(Ageing{});
  const Reloading reloading = model.reloading.value_or(Reloading{});
  const RelaxingSpring relaxing = model.relaxing.value_or(RelaxingSpring{});
  return {model.stiffness_N_per_m,
          model.natural_frequency_rad_per_s,
          model.damping_ratio,
          model.friction_difference_N,
          law.slope_N_s_per_m,
          law.alpha_s_per_m,
          ageing.rate_N,
          ageing.cutoff_s,
          reloading.force_N,
          reloading.length_m,
          model.stiffness_trend.value_or(StiffnessTrend{}).exponent,
          relaxing.share,
          relaxing.time_s};
}

double SpeedReach::distance_to(double speed_m_per_s) const {
  return std::max(0.0, from_end(*this, speed_m_per_s));
}

double SpeedReach::distance_beyond(double speed_m_per_s) const {
  const double inwards = thresholds::kTrendBegins * std::log(fastest_m_per_s / slowest_m_per_s);
  return std::max(0.0, from_end(*this, speed_m_per_s) + inwards);
}

double SpeedReach::half_width_at(double speed_m_per_s) const {
  return trend.value_or(0.0) * distance_beyond(speed_m_per_s);
}

const Parameter* FitResult::find(ParameterId id) const {
  const auto found =
      std::find_if(parameters.begin(), parameters.end(), [id](const Parameter& p) { return p.id == id; });
  return found == parameters.end() ? nullptr : &*found;
}

Estimate FitResult::estimate_of(ParameterId id) const {
  const Parameter* const parameter = find(id);
  return parameter != nullptr ? parameter->estimate : Estimate{};
}

}  // namespace slipfit
