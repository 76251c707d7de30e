#include "slipfit/predict/derived.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "predict/delta.hpp"

namespace slipfit {
namespace {

using predict::unknown;

/// gamma = F_s / F_k, [Paper] eq. (5): needs the sensor's zero.
Estimate force_ratio(const FitResult& fit, const Conditions& conditions) {
  if (!conditions.zero_force_N) return unknown("needs the sensor's zero: state it with --zero");
  const Parameter* difference = nullptr;
  const Parameter* kinetic = nullptr;
  for (const Parameter& parameter : fit.parameters) {
    if (parameter.name == "friction_difference_N") difference = &parameter;
    if (parameter.name == "kinetic_friction_N") kinetic = &parameter;
  }
  if (difference == nullptr || kinetic == nullptr || !kinetic->estimate.value || !(*kinetic->estimate.value > 0.0)) {
    return unknown("F_k is not known, or not positive");
  }
  const double f_k = *kinetic->estimate.value;
  const double excess = *difference->estimate.value / f_k;
  const double relative = std::hypot(*difference->estimate.standard_error / *difference->estimate.value,
                                     *kinetic->estimate.standard_error / f_k);
  const double se = excess * relative;
  return {1.0 + excess, se, Interval{1.0 + std::max(0.0, excess - 1.96 * se), 1.0 + excess + 1.96 * se}, {}};
}

}  // namespace

Derived derive_from_model(const FitResult& fit, const Conditions& conditions) {
  Derived derived;
  derived.gamma = force_ratio(fit, conditions);
  if (!fit.estimate) {
    const Estimate reason = unknown("needs k, w_n, zeta and F_s - F_k, which this recording does not give");
    derived.lambda = derived.lambda_critical = derived.critical_speed_m_per_s = reason;
    derived.periodic_displacement_m = derived.micro_vibration_spacing_m = reason;
    return derived;
  }
  const ModelEstimate& model = *fit.estimate;
  const double speed = conditions.speed_m_per_s;
  const predict::Propagation propagation(model);
  const predict::ModelJets p = predict::jets_of(model);
  const predict::Jet lambda = p.omega_rad_per_s * p.difference_N / (p.stiffness_N_per_m * speed);  // [Paper] eq. (9)
  derived.lambda = propagation.positive(lambda);
  predict::CriticalPoint critical = predict::critical_point(model, propagation);
  derived.lambda_critical = std::move(critical.lambda);
  derived.critical_speed_m_per_s = std::move(critical.speed_m_per_s);
  derived.micro_vibration_spacing_m = propagation.positive(predict::micro_vibration_spacing_m(p, speed));
  derived.micro_vibration_spacing_m.note = "estimate: the one-mass model has no micro-vibration inside a slip";

  const Motion motion = predict::motion_of(model, speed);
  derived.regime = predict::name_of(motion.regime);
  derived.bistable = motion.regime == Regime::StickSlipBistable;
  const std::optional<predict::CycleJets> cycle = predict::cycle_jets(model, speed);
  derived.periodic_displacement_m = cycle ? propagation.positive(cycle->periodic_displacement_m)
                                          : unknown("the fitted model has no stick-slip at this speed");
  return derived;
}

}  // namespace slipfit
