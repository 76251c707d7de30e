#include "slipfit/predict/prediction.hpp"

#include <cmath>
#include <utility>

#include "core/thresholds.hpp"
#include "predict/critical.hpp"
#include "predict/draws.hpp"
#include "slipfit/core/range.hpp"

namespace slipfit {
namespace {

using predict::Jet;

constexpr const char* kSingleSpeed =
    "one speed was measured: the intervals allow for static friction that ages and for friction and stiffness that "
    "depend on speed, as published for other materials; recordings at several speeds replace this";

Estimate without_interval(const Estimate& estimate) {
  return {estimate.value, std::nullopt, std::nullopt, estimate.note};
}

/// The motion at one speed.
class Predictor {
 public:
  Predictor(const PredictionModel& model, const predict::CriticalPoint& critical, double speed_m_per_s)
      : model_(model),
        wider_(predict::beyond(model.estimate, speed_m_per_s)),
        critical_(critical),
        speed_m_per_s_(speed_m_per_s),
        propagation_(wider_.value_or(model.estimate)),
        body_(predict::body_at<Jet>(model.estimate, speed_m_per_s)) {}

  [[nodiscard]] PredictedMotion motion() const {
    PredictedMotion row;
    row.speed_m_per_s = speed_m_per_s_;
    const predict::ModelMotion motion = predict::motion_at(model_.estimate, speed_m_per_s_);
    row.lambda = positive(motion.lambda);
    row.regime = motion.regime;
    if (motion.cycle) add_cycle(*motion.cycle, row);
    if (motion.cycle && is_beyond_observed_end()) {
      withdraw_intervals(row, "a recording of the sweep that is no faster does not stick");
    } else if (is_doubtful(motion)) {
      take_intervals_of_draws(row);
    } else if (model_.has_covariance && !wider_) {
      withdraw_intervals(row, predict::kUntrended);
    } else if (model_.has_covariance && propagation_.law_is_open_at(speed_m_per_s_)) {
      withdraw_intervals(row, "alpha is not known well enough for an interval at this speed");
    } else if (model_.has_covariance && model_.estimate.speed_dependence && may_be_either(motion.total_damping_ratio)) {
      row.note = "the data do not determine whether steady sliding is stable at this speed";
    } else if (model_.has_covariance && away_from_single_speed() > std::log(thresholds::kUntrendedRatio)) {
      row.note = kSingleSpeed;
    } else if (is_far()) {
      row.note = "more than a factor of 4 beyond the recordings";
    }
    return in_range(std::move(row));
  }

 private:
  [[nodiscard]] bool is_beyond_observed_end() const {
    const std::optional<double>& slides = model_.observed_end.slides_m_per_s;
    return slides && speed_m_per_s_ >= *slides;
  }

  /// |ln| of the ratio to the speed of the one recording; 0 for a sweep or a stated model.
  [[nodiscard]] double away_from_single_speed() const {
    const std::optional<SingleSpeed>& single = model_.estimate.single_speed;
    return single ? single->distance_to(speed_m_per_s_) : 0.0;
  }

  [[nodiscard]] bool is_far() const {
    const std::optional<SpeedReach>& reach = model_.estimate.reach;
    return reach && reach->distance_to(speed_m_per_s_) > std::log(thresholds::kFarRatio);
  }

  [[nodiscard]] Estimate positive(const Jet& y) const {
    return model_.has_covariance ? propagation_.positive(y) : Estimate{y.a, std::nullopt, std::nullopt, {}};
  }

  /// part / (part + rest): the interval is symmetric in the logarithm of part / rest, which keeps it between 0 and 1.
  [[nodiscard]] Estimate share(const Jet& part, const Jet& rest) const {
    Estimate ratio = positive(part / rest);
    const auto share_of = [](double x) { return x / (1.0 + x); };
    const double value = (part / (part + rest)).a;
    if (!ratio.ci95) return {value, std::nullopt, std::nullopt, {}};
    return {value, propagation_.standard_error(part / (part + rest)),
            Interval{share_of(ratio.ci95->low), share_of(ratio.ci95->high)}, std::string{}};
  }

  /// F_k plus a force of the cycle. How the two go together is not known: the sum of the standard errors is the most
  /// that the standard error of the sum can be.
  [[nodiscard]] Estimate force(const Jet& above_kinetic_N) const {
    if (!model_.kinetic_friction_N || !model_.kinetic_friction_N->value) return unknown("F_k is not known");
    const double value = *model_.kinetic_friction_N->value + above_kinetic_N.a;
    const std::optional<double> kinetic_se = model_.kinetic_friction_N->standard_error;
    if (!model_.has_covariance || !kinetic_se) return {value, std::nullopt, std::nullopt, {}};
    const double trend_N =
        thresholds::kKineticTrend * away_from_single_speed() * std::abs(*model_.kinetic_friction_N->value);
    const double se =
        std::hypot(*kinetic_se, trend_N / propagation_.quantile()) + propagation_.standard_error(above_kinetic_N);
    const double reach = propagation_.quantile() * se;
    return {value, se, Interval{value - reach, value + reach}, {}};
  }

  void add_cycle(const model::SlidingCycle<Jet>& cycle, PredictedMotion& row) const {
    row.period_s = positive(cycle.period_s());
    row.frequency_Hz = positive(1.0 / cycle.period_s());
    row.slip_time_s = positive(cycle.slip_s);
    row.stick_time_s = positive(cycle.stick_s);
    row.sticking_degree = share(cycle.stick_s, cycle.slip_s);
    row.periodic_displacement_m = positive(speed_m_per_s_ * cycle.period_s());
    row.micro_vibration_spacing_m = positive(predict::micro_vibration_spacing_m(body_));
    row.force_peak_N = force(cycle.peak_N);
    row.force_trough_N = force(cycle.trough_N);
  }

  /// Near its end the cycle changes with the square root of the distance: the delta method fails there. The margin is
  /// nearly linear in zeta and ln lambda, so it is informative also where zeta, and with it the critical speed, is
  /// unknown.
  [[nodiscard]] bool is_doubtful(const predict::ModelMotion& motion) const {
    if (!model_.has_covariance) return false;
    const std::optional<Interval>& critical = critical_.speed_m_per_s.ci95;
    if (critical && critical->low <= speed_m_per_s_ && speed_m_per_s_ <= critical->high) return true;
    return motion.restick_margin && may_be_either(*motion.restick_margin);
  }

  /// Over the models that the covariance allows and that stick, where linear propagation does not hold.
  void take_intervals_of_draws(PredictedMotion& row) const {
    const std::string unsure = "the data do not determine whether there is stick-slip at this speed";
    withdraw_intervals(row, "within the uncertainty of the critical speed: " + unsure);
    if (!row.period_s.value || !wider_) return;
    const predict::CyclesOfDraws cycles(*wider_, speed_m_per_s_);
    if (cycles.share() < thresholds::kLeastSticking) return;
    row.note += ", and intervals hold if there is";
    using Cycle = predict::CyclesOfDraws::Cycle;
    cycles.give_interval(row.period_s, [](const Cycle& cycle) { return cycle.period_s(); });
    cycles.give_interval(row.frequency_Hz, [](const Cycle& cycle) { return 1.0 / cycle.period_s(); });
    cycles.give_interval(row.slip_time_s, [](const Cycle& cycle) { return cycle.slip_s; });
    cycles.give_interval(row.stick_time_s, [](const Cycle& cycle) { return cycle.stick_s; });
    cycles.give_interval(row.sticking_degree, [](const Cycle& cycle) { return cycle.stick_s / cycle.period_s(); });
    cycles.give_interval(row.periodic_displacement_m,
                         [&](const Cycle& cycle) { return speed_m_per_s_ * cycle.period_s(); });
    cycles.give_interval(row.micro_vibration_spacing_m, [](const Cycle& cycle) { return cycle.micro_vibration_m; });
  }

  /// Its sign is within the uncertainty.
  [[nodiscard]] bool may_be_either(const Jet& y) const {
    return std::abs(y.a) <= propagation_.quantile() * propagation_.standard_error(y);
  }

  static PredictedMotion in_range(PredictedMotion row) {
    for (Estimate* const quantity : {&row.lambda, &row.period_s, &row.frequency_Hz, &row.slip_time_s, &row.stick_time_s,
                                     &row.periodic_displacement_m, &row.micro_vibration_spacing_m}) {
      *quantity = within(std::move(*quantity), kNotNegative);
    }
    if (!row.period_s.value) row.frequency_Hz = row.period_s;  // not 0
    row.sticking_degree = within(std::move(row.sticking_degree), kShare);
    row.force_peak_N = within(std::move(row.force_peak_N), kAnyNumber);
    row.force_trough_N = within(std::move(row.force_trough_N), kAnyNumber);
    return row;
  }

  static void withdraw_intervals(PredictedMotion& row, std::string note) {
    row.note = std::move(note);
    for (Estimate* const quantity :
         {&row.period_s, &row.frequency_Hz, &row.slip_time_s, &row.stick_time_s, &row.sticking_degree,
          &row.periodic_displacement_m, &row.micro_vibration_spacing_m, &row.force_peak_N, &row.force_trough_N}) {
      *quantity = without_interval(*quantity);
    }
  }

  const PredictionModel& model_;
  std::optional<ModelEstimate> wider_;  ///< with what is not known at this speed; empty: nothing is known there
  const predict::CriticalPoint& critical_;
  double speed_m_per_s_;
  predict::Propagation propagation_;
  model::SlidingBody<Jet> body_;
};

}  // namespace

PredictionModel stated_model(const Slider& slider, const Friction& friction) {
  PredictionModel model;
  model.estimate.stiffness_N_per_m = slider.stiffness_N_per_m();
  model.estimate.natural_frequency_rad_per_s = slider.natural_frequency_rad_per_s();
  model.estimate.damping_ratio = slider.damping_ratio();
  model.estimate.friction_difference_N = friction.difference_N();
  model.estimate.damping_identified = true;
  model.kinetic_friction_N = Estimate{friction.kinetic_N(), std::nullopt, std::nullopt, {}};
  return model;
}

PredictionModel at_load(PredictionModel model, double normal_force_N) {
  ModelEstimate& estimate = model.estimate;
  const double ratio = normal_force_N / estimate.normal_force_N.value();
  for (const ParameterId of_friction :
       {ParameterId::FrictionDifference, ParameterId::FrictionSlope, ParameterId::Ageing, ParameterId::ReloadForce}) {
    if (double* const value = estimate.find(of_friction)) *value *= ratio;
    if (enters_as_logarithm(of_friction)) continue;
    const std::size_t place = place_in_model(of_friction);
    for (std::size_t i = 0; i < kModelValues; ++i) {
      estimate.covariance[place][i] *= ratio;
      estimate.covariance[i][place] *= ratio;
    }
  }
  estimate.normal_force_N = normal_force_N;
  if (ratio != 1.0) {
    model.kinetic_friction_N.reset();
    model.observed_end = {};
  }
  return model;
}

Prediction predict_at(const PredictionModel& model, std::span<const double> speeds_m_per_s) {
  predict::CriticalPoint critical = predict::critical_point(model.estimate);
  critical.speed_m_per_s = with_observed_end(critical.speed_m_per_s, model.observed_end);
  if (!model.has_covariance) {
    critical = {without_interval(critical.lambda), without_interval(critical.speed_m_per_s)};
  }
  Prediction prediction{within(critical.speed_m_per_s, kNotNegative), within(critical.lambda, kNotNegative), {}};
  for (const double speed_m_per_s : speeds_m_per_s) {
    prediction.rows.push_back(Predictor(model, critical, speed_m_per_s).motion());
  }
  return prediction;
}

}  // namespace slipfit
