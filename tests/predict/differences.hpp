#pragma once

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <initializer_list>

#include "predict/draws.hpp"
#include "slipfit/predict/prediction.hpp"

namespace test {

/// Gives the model such standard errors, each two of them correlated by 0.2.
inline void set_errors(slipfit::PredictionModel& model, std::initializer_list<double> se) {
  for (std::size_t i = 0; i < se.size(); ++i) {
    for (std::size_t j = 0; j < se.size(); ++j) {
      model.estimate.covariance[i][j] = se.begin()[i] * se.begin()[j] * (i == j ? 1.0 : 0.2);
    }
  }
  model.has_covariance = true;
}

/// Moved by `step` in value i of ModelEstimate::covariance.
inline slipfit::PredictionModel moved(slipfit::PredictionModel model, std::size_t i, double step) {
  const slipfit::ParameterId id = slipfit::kModelParameters[i];
  if (double* const value = model.estimate.find(id)) {
    *value = slipfit::predict::moved(id, *value, step);
  }
  return model;
}

/// Of quantity(model), by central differences of two steps, whose errors go as the fourth power of the step
/// (Richardson). Steps are relative to the size of each value.
template <class Function>
double standard_error_by_differences(const slipfit::PredictionModel& model, double relative_step,
                                     const Function& quantity) {
  const slipfit::ModelEstimate& e = model.estimate;
  std::array<double, slipfit::kModelValues> sizes{};
  sizes.fill(1.0);
  if (e.speed_dependence) sizes[4] = std::abs(e.speed_dependence->slope_N_s_per_m);
  if (e.speed_dependence) sizes[5] = std::abs(e.speed_dependence->alpha_s_per_m);
  if (e.ageing) sizes[6] = e.ageing->rate_N;
  if (e.ageing && e.ageing->cutoff_s > 0.0) sizes[7] = e.ageing->cutoff_s;
  if (e.reloading) sizes[8] = e.reloading->force_N;
  if (e.stiffness_trend) sizes[10] = 0.1;
  std::array<double, slipfit::kModelValues> gradient{};
  for (std::size_t i = 0; i < gradient.size(); ++i) {
    if (!(e.covariance[i][i] > 0.0)) continue;  // known exactly: nothing follows from its error
    const auto slope = [&](double step) {
      return (quantity(moved(model, i, step)) - quantity(moved(model, i, -step))) / (2.0 * step);
    };
    const double step = relative_step * sizes[i];
    gradient[i] = (4.0 * slope(0.5 * step) - slope(step)) / 3.0;
  }
  double variance = 0.0;
  for (std::size_t i = 0; i < gradient.size(); ++i) {
    for (std::size_t j = 0; j < gradient.size(); ++j) variance += gradient[i] * e.covariance[i][j] * gradient[j];
  }
  return std::sqrt(variance);
}

inline slipfit::PredictedMotion predicted(const slipfit::PredictionModel& model, double speed_m_per_s) {
  const std::array<double, 1> speeds{speed_m_per_s};
  return slipfit::predict_at(model, speeds).rows.front();
}

inline slipfit::Estimate critical_speed(const slipfit::PredictionModel& model) {
  return slipfit::predict_at(model, {}).critical_speed_m_per_s;
}

/// Standard errors of the motion at three speeds, to 1e-7, and of the speed at which stick-slip ends against
/// differences; the motion sticks just below that and not above.
inline void check_intervals(const slipfit::PredictionModel& model, double tolerance_of_end) {
  using slipfit::PredictedMotion;
  for (const double speed : {0.0005, 0.001, 0.003}) {
    CAPTURE(speed);
    for (const auto quantity :
         {&PredictedMotion::period_s, &PredictedMotion::stick_time_s, &PredictedMotion::slip_time_s,
          &PredictedMotion::periodic_displacement_m, &PredictedMotion::lambda}) {
      const double expected = standard_error_by_differences(
          model, 1e-3, [&](const slipfit::PredictionModel& at) { return *(predicted(at, speed).*quantity).value; });
      CHECK(*(predicted(model, speed).*quantity).standard_error == Approx(expected).epsilon(1e-7));
    }
  }
  const double expected = standard_error_by_differences(
      model, 1e-3, [](const slipfit::PredictionModel& at) { return *critical_speed(at).value; });
  CHECK(*critical_speed(model).standard_error == Approx(expected).epsilon(tolerance_of_end));
  const double end = *critical_speed(model).value;
  CHECK(predicted(model, 0.999 * end).period_s.value);
  CHECK_FALSE(predicted(model, 1.001 * end).period_s.value);
}

}  // namespace test
