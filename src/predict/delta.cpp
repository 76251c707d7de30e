#include "predict/delta.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/fit_thresholds.hpp"
#include "core/student.hpp"

namespace slipfit::predict {
namespace {

constexpr std::array<double, 2> kShare{1.0, 0.5};  // that ln k and ln w_n have in exponent times ln V

constexpr std::size_t kDifferencePlace = place_in_model(ParameterId::FrictionDifference);

/// `half_width`: of the 95 % interval of ln k; w_n is that of the same mass.
void add_stiffness_error(ModelEstimate& model, double half_width) {
  const double variance = std::pow(half_width / t_quantile(model.degrees_of_freedom), 2);
  for (std::size_t i = 0; i < kShare.size(); ++i) {
    for (std::size_t j = 0; j < kShare.size(); ++j) model.covariance[i][j] += kShare[i] * kShare[j] * variance;
  }
}

/// docs/model.md section 13
ModelEstimate beyond_single(const ModelEstimate& model, double speed_m_per_s) {
  const double distance = model.single_speed->distance_to(speed_m_per_s);
  ModelEstimate wider = model;
  // At the speed itself the recording shows the cycle, however the parameters share it out.
  const double share = std::min(1.0, distance / std::log(thresholds::kUntrendedRatio));
  for (std::size_t i = 0; i < model.single_speed->least_errors.size(); ++i) {
    const double least = share * model.single_speed->least_errors[i];
    wider.covariance[i][i] = std::max(wider.covariance[i][i], least * least);
  }
  const double friction_error = thresholds::kFrictionTrend * distance / t_quantile(model.degrees_of_freedom);
  wider.covariance[kDifferencePlace][kDifferencePlace] += friction_error * friction_error;
  add_stiffness_error(wider, thresholds::kStiffnessTrend * distance);
  return wider;
}

}  // namespace

Propagation::Propagation(const ModelEstimate& model)
    : model_(model), quantile_(t_quantile(model_.degrees_of_freedom)) {}

double Propagation::standard_error(const Jet& y) const {
  double variance = 0.0;
  for (std::size_t i = 0; i < kModelValues; ++i) {
    for (std::size_t j = 0; j < kModelValues; ++j) {
      variance += y.v[static_cast<Eigen::Index>(i)] * model_.covariance[i][j] * y.v[static_cast<Eigen::Index>(j)];
    }
  }
  return std::sqrt(std::max(0.0, variance));  // rounding may leave a small negative number
}

Estimate Propagation::positive(const Jet& y) const {
  const double relative = standard_error(y) / y.a;
  const double factor = std::exp(quantile_ * relative);
  return {y.a, relative * y.a, Interval{y.a / factor, y.a * factor}, {}};
}

bool Propagation::law_is_open_at(double speed_m_per_s) const {
  return quantile_ * standard_error(parameter_of<Jet>(model_, ParameterId::Alpha)) * speed_m_per_s >
         thresholds::kStraightLaw;
}

std::optional<ModelEstimate> beyond(const ModelEstimate& model, double speed_m_per_s) {
  if (model.single_speed) return beyond_single(model, speed_m_per_s);
  if (!model.reach) return model;
  const bool is_far = !(model.reach->distance_to(speed_m_per_s) < std::log(thresholds::kUntrendedRatio));
  if (!model.reach->trend && is_far) return std::nullopt;
  ModelEstimate wider = model;
  wider.covariance[kDifferencePlace][kDifferencePlace] +=
      std::pow(model.reach->half_width_at(speed_m_per_s) / t_quantile(model.degrees_of_freedom), 2);
  if (model.stiffness_trend) {
    // It may end there, or double.
    add_stiffness_error(wider, model.stiffness_trend->exponent * model.reach->distance_beyond(speed_m_per_s));
  }
  return wider;
}

Jet micro_vibration_spacing_m(const model::SlidingBody<Jet>& body) {
  const Jet damped_omega = body.omega_rad_per_s * sqrt(1.0 - body.zeta * body.zeta);
  return 2.0 * std::numbers::pi * body.speed_m_per_s / damped_omega;
}

}  // namespace slipfit::predict
