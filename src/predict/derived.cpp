#include "slipfit/predict/derived.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "core/statistics.hpp"
#include "core/thresholds.hpp"
#include "core/unknown.hpp"
#include "predict/critical.hpp"
#include "predict/draws.hpp"
#include "slipfit/predict/observed_end.hpp"
#include "slipfit/predict/single_speed.hpp"

namespace slipfit {

namespace {

/// gamma = F_s / F_k, [Paper] eq. (5): needs the sensor's zero.
Estimate force_ratio(const FitResult& fit, const Conditions& conditions) {
  if (!conditions.zero_force_N) return unknown("needs the sensor's zero: state it with --zero");
  const Parameter* const difference = fit.find(ParameterId::FrictionDifference);
  const Parameter* const kinetic = fit.find(ParameterId::KineticFriction);
  if (difference == nullptr || kinetic == nullptr || !kinetic->estimate.value || !(*kinetic->estimate.value > 0.0)) {
    return unknown("F_k is not known, or not positive");
  }
  const double f_k = *kinetic->estimate.value;
  const double excess = *difference->estimate.value / f_k;
  const double relative = std::hypot(*difference->estimate.standard_error / *difference->estimate.value,
                                     *kinetic->estimate.standard_error / f_k);
  const double se = excess * relative;
  return {1.0 + excess,
          se,
          Interval{1.0 + std::max(0.0, excess - kNormalQuantile * se), 1.0 + excess + kNormalQuantile * se},
          {}};
}

/// E_n of ISO 13528, (predicted - measured) / U with U from the 95 % reach of the prediction and of the measurement.
Estimate spacing_score(const Estimate& predicted_m, double measured_m, std::optional<double> measured_se_m) {
  if (!predicted_m.value || !predicted_m.ci95) return unknown("needs a predicted spacing with its interval");
  const double difference_m = *predicted_m.value - measured_m;
  const double reach_m =
      difference_m > 0.0 ? *predicted_m.value - predicted_m.ci95->low : predicted_m.ci95->high - *predicted_m.value;
  const double both_m = std::hypot(reach_m, kNormalQuantile * measured_se_m.value_or(0.0));
  if (!(both_m > 0.0)) return unknown("the predicted spacing has no width");
  return {difference_m / both_m, std::nullopt, std::nullopt,
          measured_se_m ? "" : "the measured spacing counts as exact: its own uncertainty would make this smaller"};
}

/// V, and with it every distance at the measured speed, has the error of the stated speed.
Estimate with_speed_error(Estimate distance, double relative_se, double quantile) {
  if (!distance.value || !distance.standard_error || relative_se == 0.0) return distance;
  const double relative = std::hypot(*distance.standard_error / *distance.value, relative_se);
  const double factor = std::exp(quantile * relative);
  distance.standard_error = relative * *distance.value;
  distance.ci95 = Interval{*distance.value / factor, *distance.value * factor};
  return distance;
}

/// k V is what the data give: at the measured speed the error of V is none of the motion's.
ModelEstimate at_the_measured_speed(ModelEstimate model, double relative_speed_se) {
  double& variance = model.covariance[0][0];
  variance = std::max(0.0, variance - relative_speed_se * relative_speed_se);
  return model;
}

Estimate why_no_model(const FitResult& fit) {
  return unknown(fit.tier == Tier::Weakening ? "not derived for friction that weakens over a slip distance"
                                             : "needs k, w_n, zeta and F_s - F_k, which this recording does not give");
}

}  // namespace

Derived derive_from_model(const FitResult& fit, const Conditions& conditions) {
  Derived derived;
  derived.gamma = force_ratio(fit, conditions);
  if (!fit.estimate) {
    const Estimate reason = why_no_model(fit);
    derived.lambda = derived.lambda_critical = derived.critical_speed_m_per_s = reason;
    derived.periodic_displacement_m = derived.micro_vibration_spacing_m = reason;
    if (conditions.measured_spacing_m) derived.measured_spacing_En = reason;
    return derived;
  }
  const double speed = conditions.speed_m_per_s;
  const double speed_error = conditions.relative_speed_error();
  const ModelEstimate model = at_the_measured_speed(from_single_speed(fit, speed), speed_error);
  const predict::Propagation propagation(model);
  const auto body = predict::body_at<predict::Jet>(model, speed);
  derived.lambda = propagation.positive(body.lambda());
  predict::CriticalPoint critical = predict::critical_point(model);
  derived.lambda_critical = std::move(critical.lambda);
  const auto at_uncertain_speed = [&](Estimate distance) {
    return with_speed_error(std::move(distance), speed_error, propagation.quantile());
  };
  derived.critical_speed_m_per_s = with_observed_end(at_uncertain_speed(std::move(critical.speed_m_per_s)), {});
  derived.micro_vibration_spacing_m =
      at_uncertain_speed(propagation.positive(predict::micro_vibration_spacing_m(body)));
  derived.micro_vibration_spacing_m.note = "estimate: the one-mass model has no micro-vibration inside a slip";

  const predict::ModelMotion motion = predict::motion_at(model, speed);
  derived.regime = motion.regime;
  derived.periodic_displacement_m = motion.cycle
                                        ? at_uncertain_speed(propagation.positive(speed * motion.cycle->period_s()))
                                        : unknown("the fitted model has no stick-slip at this speed");
  if (conditions.measured_spacing_m) {
    derived.measured_spacing_En = spacing_score(derived.periodic_displacement_m, *conditions.measured_spacing_m,
                                                conditions.measured_spacing_se_m);
  }
  return derived;
}

Derived derive_from_sweep(const FitResult& fit, const ObservedEnd& observed) {
  Derived derived;
  derived.observed_end = observed;
  const Estimate one_speed = unknown("belongs to one speed: see the recordings, or slipfit predict");
  for (Estimate* const quantity :
       {&derived.lambda, &derived.gamma, &derived.periodic_displacement_m, &derived.pattern_spacing_m,
        &derived.micro_vibration_spacing_m, &derived.impulse_rate_per_m}) {
    *quantity = one_speed;
  }
  if (!fit.estimate) {
    derived.lambda_critical = unknown("needs k, w_n, zeta and F_s - F_k, which these recordings do not give");
    derived.critical_speed_m_per_s = with_observed_end(derived.lambda_critical, observed);
    return derived;
  }
  predict::CriticalPoint critical = predict::critical_point(*fit.estimate);
  derived.lambda_critical = std::move(critical.lambda);
  derived.critical_speed_m_per_s = with_observed_end(critical.speed_m_per_s, observed);
  return derived;
}

ModelEstimate from_single_speed(ModelEstimate model, double speed_m_per_s,
                                const std::array<ParameterStatus, 4>& statuses) {
  SingleSpeed single{speed_m_per_s, {}};
  for (std::size_t i = 0; i < statuses.size(); ++i) {
    if (statuses[i] == ParameterStatus::Identified || statuses[i] == ParameterStatus::Fixed) continue;
    const ParameterId id = kModelParameters[i];
    const bool is_conditional = statuses[i] == ParameterStatus::Conditional;
    // What else acts as a spring within a slip does so at other speeds, too.
    if (is_conditional && id == ParameterId::NaturalFrequency) continue;
    const double relative = is_conditional ? info(id).identified_below : thresholds::kWeakError;
    const double scale = id == ParameterId::DampingRatio ? model.damping_ratio : 1.0;  // the others by their logarithms
    single.least_errors[i] = scale * relative;
  }
  model.single_speed = single;
  return model;
}

ModelEstimate from_single_speed(const FitResult& fit, double speed_m_per_s) {
  assert(fit.estimate);
  std::array<ParameterStatus, 4> statuses{};
  for (std::size_t i = 0; i < statuses.size(); ++i) {
    const Parameter* const parameter = fit.find(kModelParameters[i]);
    statuses[i] = parameter != nullptr ? parameter->status : ParameterStatus::Unidentified;
  }
  return from_single_speed(*fit.estimate, speed_m_per_s, statuses);
}

namespace {

/// Estimates the end by the runs alone. `why` says why the fit does not determine it.
Estimate by_runs(const ObservedEnd& observed, const std::string& why) {
  const double sticks = *observed.sticks_m_per_s;
  if (!observed.slides_m_per_s) {
    return unknown(
        fmt::format("above {:.4g} m/s, the fastest run, which sticks; the fit gives no upper bound: {}", sticks, why));
  }
  const double slides = *observed.slides_m_per_s;
  return {
      std::sqrt(sticks * slides), std::nullopt, Interval{sticks, slides},
      fmt::format("by the runs: the fastest that sticks and the slowest that does not; the fit does not determine it: "
                  "{}",
                  why)};
}

/// Puts an interval without an upper end into words.
Estimate with_bound_in_words(const Estimate& by_fit) {
  if (by_fit.value || !by_fit.ci95) return by_fit;
  return unknown(fmt::format("above {:.4g} m/s; no upper bound: {}", by_fit.ci95->low, by_fit.note));
}

}  // namespace

Estimate with_observed_end(const Estimate& by_fit, const ObservedEnd& observed) {
  if (!observed.sticks_m_per_s) return with_bound_in_words(by_fit);
  if (!by_fit.value && !by_fit.ci95) return by_runs(observed, by_fit.note);
  if (!by_fit.ci95) return by_fit;
  const double sticks = *observed.sticks_m_per_s;
  const double slides = observed.slides_m_per_s.value_or(HUGE_VAL);
  if (by_fit.ci95->high < sticks) return by_runs(observed, "the fit puts it below a speed at which a run sticks");
  if (by_fit.ci95->low > slides) return by_runs(observed, "the fit puts it above a speed at which a run slides");
  Estimate both = by_fit;
  both.ci95 = Interval{std::max(by_fit.ci95->low, sticks), std::min(by_fit.ci95->high, slides)};
  if (!both.value && std::isfinite(both.ci95->high)) both.value = std::sqrt(both.ci95->low * both.ci95->high);
  if (both.value) both.value = std::clamp(*both.value, both.ci95->low, both.ci95->high);
  return with_bound_in_words(both);
}

}  // namespace slipfit
