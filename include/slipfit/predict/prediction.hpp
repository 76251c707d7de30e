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

/// What a prediction starts from: Coulomb friction or friction that depends on the speed, fitted or stated.
struct PredictionModel {
  ModelEstimate estimate;                      ///< friction_difference_N >= 0
  bool has_covariance = false;                 ///< false: `estimate.covariance` means nothing, and no interval is given
  std::optional<Estimate> kinetic_friction_N;  ///< F_k(0+); absolute forces need it
  ObservedEnd observed_end{};                  ///< what the runs of a sweep show
};

/// Parameters that somebody states: no intervals.
PredictionModel stated_model(const Slider& slider, const Friction& friction);

/// The same pair under another normal force: friction is proportional to it. F_k becomes unknown, since the sensor's
/// zero does not follow. Needs `estimate.normal_force_N`; load > 0.
PredictionModel at_load(PredictionModel model, double normal_force_N);

/// The stick-slip motion at one speed. Where the model has none, everything but lambda is empty. Intervals are those of
/// the mean cycle, by the delta method; those of forces are upper bounds (the covariance of F_k with the rest is not
/// known).
struct PredictedMotion {
  double speed_m_per_s = 0.0;
  Regime regime = Regime::ContinuousSlip;
  Estimate lambda;
  Estimate period_s, frequency_Hz, slip_time_s, stick_time_s, sticking_degree;
  Estimate periodic_displacement_m, micro_vibration_spacing_m;
  Estimate force_peak_N, force_trough_N;  ///< spring view
  /// Not empty where the data cannot tell whether there is stick-slip at this speed, or alpha is too little known for
  /// it: regime and values are those of the best estimate, without intervals. Also where they cannot tell whether
  /// steady sliding is stable: the values keep their intervals.
  std::string note;
};

struct Prediction {
  Estimate critical_speed_m_per_s, lambda_critical;
  std::vector<PredictedMotion> rows;  ///< in the order of the speeds
};

/// The motion at each speed (> 0) and the end of stick-slip.
Prediction predict_at(const PredictionModel& model, std::span<const double> speeds_m_per_s);

}  // namespace slipfit
