#pragma once

// The delta method: what follows from a fitted model, with exact derivatives. docs/formats.md says what the bands mean.

#include <ceres/jet.h>

#include <cmath>
#include <optional>
#include <string>

#include "core/unknown.hpp"
#include "slipfit/core/estimate.hpp"
#include "slipfit/fit/result.hpp"
#include "slipfit/model/motion.hpp"

namespace slipfit::predict {

/// Numbers that know their derivatives with respect to (ln k, ln w_n, zeta, ln dF, b, alpha, rate and
/// cut-off of ageing, A and ln l of reloading, exponent of k, share and ln t_r of relaxation).
using Jet = ceres::Jet<double, static_cast<int>(kModelValues)>;

/// Holds the parameters of a model whose values are the first among what a number of this kind has derivatives with
/// respect to.
template <class AnyJet>
struct ModelJetsOf {
  AnyJet stiffness_N_per_m, omega_rad_per_s, damping_ratio, difference_N, slope_N_s_per_m, alpha_s_per_m, ageing_N,
      ageing_cutoff_s, reload_force_N, reload_length_m, relaxation, relaxation_time_s;

  explicit ModelJetsOf(const ModelEstimate& model)
      : stiffness_N_per_m(positive(model.stiffness_N_per_m, ParameterId::Stiffness)),
        omega_rad_per_s(positive(model.natural_frequency_rad_per_s, ParameterId::NaturalFrequency)),
        damping_ratio(parameter(model.damping_ratio, ParameterId::DampingRatio)),
        difference_N(positive(model.friction_difference_N, ParameterId::FrictionDifference)) {
    const SpeedDependence law = model.speed_dependence.value_or(SpeedDependence{});
    const Ageing ageing = model.ageing.value_or(Ageing{});
    const Reloading reloading = model.reloading.value_or(Reloading{});
    const RelaxingSpring relaxing = model.relaxing.value_or(RelaxingSpring{});
    slope_N_s_per_m = parameter(law.slope_N_s_per_m, ParameterId::FrictionSlope);
    alpha_s_per_m = parameter(law.alpha_s_per_m, ParameterId::Alpha);
    ageing_N = parameter(ageing.rate_N, ParameterId::Ageing);
    ageing_cutoff_s = parameter(ageing.cutoff_s, ParameterId::AgeingTime);
    reload_force_N = parameter(reloading.force_N, ParameterId::ReloadForce);
    reload_length_m = positive(reloading.length_m, ParameterId::ReloadLength);
    relaxation = parameter(relaxing.share, ParameterId::Relaxation);
    relaxation_time_s = positive(relaxing.time_s, ParameterId::RelaxationTime);
  }

 private:
  static AnyJet parameter(double value, ParameterId id) { return {value, static_cast<int>(place_in_model(id))}; }
  /// One whose logarithm the model has.
  static AnyJet positive(double value, ParameterId id) {
    AnyJet jet(value);
    jet.v[static_cast<int>(place_in_model(id))] = value;
    return jet;
  }
};

using ModelJets = ModelJetsOf<Jet>;

/// The model with k and w_n of a speed, where they go with it, and the covariance of these.
ModelEstimate at_speed(const ModelEstimate& model, double speed_m_per_s);

inline constexpr int kExponent = static_cast<int>(place_in_model(ParameterId::StiffnessExponent));

/// Converts derivatives with respect to k and w_n of a speed to those of the model's parameters, which are the first in
/// y.
template <class AnyJet>
AnyJet from_speed(AnyJet y, const ModelEstimate& model, double speed_m_per_s) {
  if (!model.stiffness_trend) return y;
  const double log_speed = std::log(speed_m_per_s / model.stiffness_trend->speed_m_per_s);
  y.v[kExponent] += log_speed * (y.v[0] + 0.5 * y.v[1]);
  return y;
}

/// The model at one speed.
template <class AnyJet>
ModelJetsOf<AnyJet> jets_at(const ModelEstimate& model, double speed_m_per_s) {
  ModelJetsOf<AnyJet> jets(at_speed(model, speed_m_per_s));
  for (AnyJet* const y : {&jets.stiffness_N_per_m, &jets.omega_rad_per_s}) *y = from_speed(*y, model, speed_m_per_s);
  return jets;
}

/// Computes standard errors and 95 % intervals from derivatives.
class Propagation {
 public:
  explicit Propagation(const ModelEstimate& model);

  [[nodiscard]] double standard_error(const Jet& y) const;
  /// 97.5 % quantile of Student's t
  [[nodiscard]] double quantile() const { return quantile_; }
  /// Positive quantity: the interval is symmetric in its logarithm, which keeps it positive.
  [[nodiscard]] Estimate positive(const Jet& y) const;
  /// alpha is too little known for this speed: linear propagation takes exp(alpha V) for straight over its interval. Up
  /// to this reach of alpha V bands hold 93 % or more of the motions that the covariance allows (tests/predict); at 1.6
  /// it was 88 %, at 2.4 84 %.
  [[nodiscard]] bool law_is_open_at(double speed_m_per_s) const;

 private:
  ModelEstimate model_;
  double quantile_ = 0.0;
};

/// States why there is no interval far outside the speeds of such a sweep.
inline constexpr const char* kUntrended =
    "two recordings, or speeds within a factor of 2, cannot tell whether static friction ages: nothing is known more "
    "than a factor of 1.5 beyond them";

/// Returns the model with what its recordings do not determine at a speed outside theirs; empty where a sweep
/// determines nothing there.
std::optional<ModelEstimate> beyond(const ModelEstimate& model, double speed_m_per_s);

/// Where stick-slip from rest ends; at zeta = 0 it has no end, from zeta = 1 on there is none. The interval of the
/// speed may reach to infinity: it has no value then.
struct CriticalPoint {
  Estimate lambda, speed_m_per_s;

  static CriticalPoint unknown(const std::string& why) { return {slipfit::unknown(why), slipfit::unknown(why)}; }
};

/// One stick-slip cycle; forces of the spring above F_k.
struct CycleJets {
  Jet slip_s, stick_s, period_s, periodic_displacement_m, force_peak_N, force_trough_N;
};

/// Its stick, period and distance where the force rises more steeply after a slip than by k x, as `model` has it.
CycleJets reloaded(CycleJets cycle, const ModelEstimate& model, double speed_m_per_s);

/// The motion at one speed.
struct MotionJets {
  Regime regime = Regime::ContinuousSlip;
  std::optional<Jet> aged_difference_N;  ///< F_s - F_k(0+) after the sticks of this speed, where it ages
  std::optional<CycleJets> cycle;        ///< empty: no stick-slip
  std::optional<Jet> restick_margin;     ///< > 0 where the slip sticks again, nearly linear around 0; empty: not known
  Jet total_damping_ratio;  ///< of small oscillations around steady sliding, which is unstable where it is < 0
};
/// Spacing of the free oscillation inside a slip, an estimate only: V 2 pi / w. docs/model.md section 8
Jet micro_vibration_spacing_m(const ModelJets& model, double speed_m_per_s);

}  // namespace slipfit::predict
