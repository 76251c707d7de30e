#pragma once

// The delta method: what follows from a fitted model, with exact derivatives. docs/formats.md says what the bands mean.

#include <ceres/jet.h>
#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>
#include <vector>

#include "core/statistics.hpp"
#include "model/sliding.hpp"
#include "slipfit/core/estimate.hpp"
#include "slipfit/fit/result.hpp"

namespace slipfit::predict {

/// Numbers that know their derivatives with respect to kModelParameters, as these enter the covariance.
using Jet = ceres::Jet<double, static_cast<int>(kModelValues)>;

/// Numbers of a model whose parameters' errors do not matter.
using Plain = ceres::Jet<double, 1>;

/// Returns a parameter of a model; 0 where the model does not contain it. kModelParameters are the first among what a
/// number of this kind has derivatives with respect to.
template <class AnyJet>
AnyJet parameter_of(const ModelEstimate& model, ParameterId id) {
  const double* const value = model.find(id);
  if (value == nullptr) return AnyJet(0.0);
  AnyJet jet(*value);
  if constexpr (!std::is_same_v<AnyJet, Plain>) {
    jet.v[static_cast<int>(place_in_model(id))] = enters_as_logarithm(id) ? *value : 1.0;
  }
  return jet;
}

/// Returns the value of one of kModelParameters after a move of what the covariance is of.
inline double moved(ParameterId id, double value, double move) {
  return enters_as_logarithm(id) ? value * std::exp(move) : value + move;
}

/// Returns the model's body at a speed.
template <class AnyJet>
model::SlidingBody<AnyJet> body_at(const ModelEstimate& model, double speed_m_per_s) {
  const auto of = [&model](ParameterId id) { return parameter_of<AnyJet>(model, id); };
  model::SlidingBody<AnyJet> body{speed_m_per_s,
                                  of(ParameterId::Stiffness),
                                  of(ParameterId::NaturalFrequency),
                                  of(ParameterId::DampingRatio),
                                  of(ParameterId::FrictionDifference),
                                  of(ParameterId::FrictionSlope),
                                  of(ParameterId::Alpha)};
  if (model.stiffness_trend) {
    const double log_speed = std::log(speed_m_per_s / model.stiffness_trend->speed_m_per_s);
    const AnyJet growth = exp(of(ParameterId::StiffnessExponent) * log_speed);
    body.stiffness_N_per_m *= growth;
    body.omega_rad_per_s *= sqrt(growth);  // of the same mass
  }
  if (model.ageing) {
    body.ageing = {of(ParameterId::Ageing), of(ParameterId::AgeingTime), model.ageing->reference_stick_s};
  }
  if (model.reloading) body.rise = {of(ParameterId::ReloadForce), of(ParameterId::ReloadLength)};
  if (model.relaxing) body.relaxation = {of(ParameterId::Relaxation), of(ParameterId::RelaxationTime)};
  return body;
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

/// Spacing of the free oscillation inside a slip, an estimate only: V 2 pi / w. docs/model.md section 8
Jet micro_vibration_spacing_m(const model::SlidingBody<Jet>& body);

/// The motion of a model at one speed, above 0.
struct ModelMotion {
  Regime regime = Regime::ContinuousSlip;
  Jet lambda;  ///< SlidingBody::lambda, where static friction ages that after the sticks of this speed
  std::optional<model::SlidingCycle<Jet>> cycle;  ///< empty: no stick-slip
  std::optional<Jet> restick_margin;              ///< SlidingBody::restick_margin
  Jet total_damping_ratio;                        ///< SlidingBody::total_damping_ratio
};

/// Returns that motion; where static friction ages with that of the limit cycle, to a share of `sharp`.
ModelMotion motion_at(const ModelEstimate& model, double speed_m_per_s, double sharp = model::kSharpDifference);

/// Returns whether a model has stick-slip at a speed; where static friction ages by that of the limit cycle, to a share
/// of `sharp`.
bool sticks_at(const ModelEstimate& model, double speed_m_per_s, double sharp = model::kSharpDifference);

/// Models that the covariance of `model` allows, always the same ones: for what linear propagation cannot follow. Their
/// spread is normal and as wide as Student's t makes the intervals; what is no model is
/// left out: zeta outside [0, 1), static friction that falls with the stick time, a cut-off or rise below 0, numbers
/// that are not finite.
std::vector<ModelEstimate> draws_of(const ModelEstimate& model);

/// The cycles at one speed of the models that the covariance of `model` allows.
class CyclesOfDraws {
 public:
  struct Cycle {
    double slip_s, stick_s, micro_vibration_m;
    [[nodiscard]] double period_s() const { return slip_s + stick_s; }
  };

  CyclesOfDraws(const ModelEstimate& model, double speed_m_per_s);

  /// Returns the share of the models that stick.
  [[nodiscard]] double share() const { return share_; }
  /// Gives the interval over those that stick, `value_of` a cycle being what is estimated.
  template <class ValueOf>
  void give_interval(Estimate& estimate, const ValueOf& value_of) const {
    constexpr double kTail = 0.025;
    std::vector<double> values;
    for (const Cycle& cycle : cycles_) values.push_back(value_of(cycle));
    const double low = std::min(quantile_of(values, kTail), *estimate.value);
    const double high = std::max(quantile_of(values, 1.0 - kTail), *estimate.value);
    estimate.ci95 = Interval{low, high};
    estimate.standard_error = 0.5 * (high - low) / quantile_;
  }

 private:
  double quantile_;
  double share_ = 0.0;
  std::vector<Cycle> cycles_;
};

}  // namespace slipfit::predict
