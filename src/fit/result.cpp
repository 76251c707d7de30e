#include "slipfit/fit/result.hpp"

#include <algorithm>
#include <cmath>

#include "core/thresholds.hpp"

namespace slipfit {

namespace {

/// ln of the ratio to the nearer end of the speeds; below 0 among them.
double from_end(const SpeedReach& reach, double speed_m_per_s) {
  return std::max(std::log(speed_m_per_s / reach.fastest_m_per_s), std::log(reach.slowest_m_per_s / speed_m_per_s));
}

template <class Value, class Model>
Value* find_value(Model& model, ParameterId id) {
  const auto in = [](auto& part, auto member) -> Value* { return part ? &((*part).*member) : nullptr; };
  switch (id) {
    case ParameterId::Stiffness:
      return &model.stiffness_N_per_m;
    case ParameterId::NaturalFrequency:
      return &model.natural_frequency_rad_per_s;
    case ParameterId::DampingRatio:
      return &model.damping_ratio;
    case ParameterId::FrictionDifference:
      return &model.friction_difference_N;
    case ParameterId::FrictionSlope:
      return in(model.speed_dependence, &SpeedDependence::slope_N_s_per_m);
    case ParameterId::Alpha:
      return in(model.speed_dependence, &SpeedDependence::alpha_s_per_m);
    case ParameterId::Ageing:
      return in(model.ageing, &Ageing::rate_N);
    case ParameterId::AgeingTime:
      return in(model.ageing, &Ageing::cutoff_s);
    case ParameterId::ReloadForce:
      return in(model.reloading, &Reloading::force_N);
    case ParameterId::ReloadLength:
      return in(model.reloading, &Reloading::length_m);
    case ParameterId::StiffnessExponent:
      return in(model.stiffness_trend, &StiffnessTrend::exponent);
    case ParameterId::Relaxation:
      return in(model.relaxing, &RelaxingSpring::share);
    case ParameterId::RelaxationTime:
      return in(model.relaxing, &RelaxingSpring::time_s);
    default:
      return nullptr;
  }
}

}  // namespace

double* ModelEstimate::find(ParameterId id) {
  return find_value<double>(*this, id);
}

const double* ModelEstimate::find(ParameterId id) const {
  return find_value<const double>(*this, id);
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
