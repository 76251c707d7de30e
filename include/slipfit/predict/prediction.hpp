#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "slipfit/core/estimate.hpp"
#include "slipfit/fit/fit.hpp"
#include "slipfit/model/motion.hpp"
#include "slipfit/predict/observed_end.hpp"

namespace slipfit {

/// The model of a prediction: Coulomb friction or friction that depends on speed, fitted or stated.
struct PredictionModel {
  ModelEstimate estimate;                      ///< friction_difference_N >= 0
  bool has_covariance = false;                 ///< false: `estimate.covariance` means nothing, and no interval is given
  std::optional<Estimate> kinetic_friction_N;  ///< F_k(0+); absolute forces need it
  ObservedEnd observed_end{};                  ///< what the runs of a sweep show
};

/// Returns a model of stated parameters, without intervals.
PredictionModel stated_model(const Slider& slider, const Friction& friction);

/// Returns the model under another normal force, to which friction is proportional. F_k becomes unknown, because the
/// zero of the sensor does not scale. `estimate.normal_force_N` is required; load > 0.
PredictionModel at_load(PredictionModel model, double normal_force_N);

/// The stick-slip motion at one speed. If the model has none, everything but lambda is empty. Intervals are those of
/// the mean cycle, by the delta method; those of forces are upper bounds (the covariance of F_k with the rest is
/// unknown).
struct PredictedMotion {
  double speed_m_per_s = 0.0;
  Regime regime = Regime::ContinuousSlip;
  Estimate lambda;
  Estimate period_s, frequency_Hz, slip_time_s, stick_time_s, sticking_degree;
  Estimate periodic_displacement_m, micro_vibration_spacing_m;
  Estimate force_peak_N, force_trough_N;  ///< spring view
  /// The reason why the data do not determine whether there is stick-slip at this speed, or why alpha is too uncertain
  /// for it: regime and values are then those of the best estimate, without intervals. It is also set if the data do
  /// not determine whether steady sliding is stable: the values then keep their intervals. Otherwise it is empty.
  std::string note;
};

struct Prediction {
  Estimate critical_speed_m_per_s, lambda_critical;
  std::vector<PredictedMotion> rows;  ///< in the order of the speeds
};

/// Predicts the motion at each speed (> 0) and the end of stick-slip.
Prediction predict_at(const PredictionModel& model, std::span<const double> speeds_m_per_s);

}  // namespace slipfit
