#include "slipfit/predict/derived.hpp"

#include <ceres/jet.h>

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numbers>

#include "model/slip.hpp"
#include "slipfit/model/motion.hpp"

namespace slipfit {
namespace {

/// Numbers that know their derivatives with respect to (ln k, ln w_n, zeta, ln dF).
using Jet = ceres::Jet<double, 4>;

double variance_of(const Jet& y, const ModelEstimate& model) {
  double variance = 0.0;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      variance += y.v[i] * model.covariance[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] * y.v[j];
    }
  }
  return variance;
}

/// Positive quantity: the interval is symmetric in its logarithm, which keeps it positive.
Estimate positive_estimate(const Jet& y, const ModelEstimate& model) {
  const double relative = std::sqrt(variance_of(y, model)) / y.a;
  const boost::math::students_t_distribution<double> student(std::max(1.0, model.degrees_of_freedom));
  const double factor = std::exp(boost::math::quantile(student, 0.975) * relative);
  return {y.a, relative * y.a, Interval{y.a / factor, y.a * factor}, {}};
}

Estimate unknown(std::string reason) {
  return {std::nullopt, std::nullopt, std::nullopt, std::move(reason)};
}

std::string name_of(Regime regime) {
  switch (regime) {
    case Regime::StickSlip:
      return "stick_slip";
    case Regime::StickSlipBistable:
      return "stick_slip_bistable";
    case Regime::OscillatorySlip:
      return "oscillatory_slip";
    case Regime::ContinuousSlip:
      return "continuous_slip";
    case Regime::UnstableSteady:
      return "unstable_steady";
  }
  return {};
}

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

void derive_critical(const ModelEstimate& model, const Jet& lambda, const Jet& zeta, double speed_m_per_s,
                     Derived& derived) {
  if (!model.damping_identified || !(zeta.a > 0.0)) {
    derived.lambda_critical = unknown("the damping ratio cannot be told from 0");
    derived.critical_speed_m_per_s = derived.lambda_critical;
    return;
  }
  const double solution = critical_lambda(zeta.a);
  // One Newton step in dual numbers: derivatives of the root by the implicit function theorem.
  const ceres::Jet<double, 1> at(solution, 0);
  const double slope = model::restick_margin(at, ceres::Jet<double, 1>(zeta.a)).v[0];
  const Jet critical = Jet(solution) - model::restick_margin(Jet(solution), zeta) / slope;
  derived.lambda_critical = positive_estimate(critical, model);
  derived.critical_speed_m_per_s = positive_estimate(speed_m_per_s * lambda / critical, model);
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
  const Jet stiffness = exp(Jet(std::log(model.stiffness_N_per_m), 0));
  const Jet omega = exp(Jet(std::log(model.natural_frequency_rad_per_s), 1));
  const Jet zeta(model.damping_ratio, 2);
  const Jet difference = exp(Jet(std::log(model.friction_difference_N), 3));
  const Jet lambda = omega * difference / (stiffness * speed);  // [Paper] eq. (9)
  derived.lambda = positive_estimate(lambda, model);
  derive_critical(model, lambda, zeta, speed, derived);

  // Micro-vibration inside a slip: one period of the damped oscillation. model.md section 8
  const Jet damped_omega = omega * sqrt(1.0 - zeta * zeta);
  derived.micro_vibration_spacing_m = positive_estimate(2.0 * std::numbers::pi * speed / damped_omega, model);
  derived.micro_vibration_spacing_m.note = "estimate: the one-mass model has no micro-vibration inside a slip";

  const auto slider = Slider::create(model.stiffness_N_per_m, model.natural_frequency_rad_per_s, model.damping_ratio);
  const auto friction = Friction::create(model.friction_difference_N, 0.0);  // only the difference matters here
  if (!slider || !friction) return derived;
  const Motion motion = damped_motion(slider.value(), friction.value(), speed);
  derived.regime = name_of(motion.regime);
  derived.bistable = motion.regime == Regime::StickSlipBistable;
  if (!motion.cycle) {
    derived.periodic_displacement_m = unknown("the fitted model has no stick-slip at this speed");
    return derived;
  }
  // dx = V (t_slip + t_stick) = (V / w_n) (tau_end + z0 - z_end)
  const Jet z0 = lambda - 2.0 * zeta;
  const model::Slip slip = model::solve_slip(z0.a, zeta.a);
  const Jet tau_end = model::slip_end(slip, z0, zeta);
  const Jet z_end = model::slip_point(z0, zeta, tau_end).z;
  derived.periodic_displacement_m = positive_estimate(speed / omega * (tau_end + z0 - z_end), model);
  return derived;
}

}  // namespace slipfit
