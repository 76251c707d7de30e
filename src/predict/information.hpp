#pragma once

#include <Eigen/Dense>
#include <optional>

#include "slipfit/fit/result.hpp"
#include "slipfit/predict/recording_plan.hpp"

namespace slipfit::predict {

/// ModelEstimate's values in the order of its covariance, then the force level F_k(0+) in newtons.
inline constexpr int kPlanValues = static_cast<int>(kModelValues) + 1;
using PlanMatrix = Eigen::Matrix<double, kPlanValues, kPlanValues>;

/// White noise of a sample and scatter of the static friction; 0: the static friction is the same in all cycles.
struct Disturbance {
  double noise_rms_N = 0.0;
  double static_friction_sd_N = 0.0;
};

struct Information {
  PlanMatrix matrix = PlanMatrix::Zero();
  double cycles = 0.0;
  double samples_per_slip = 0.0;
};

/// Fisher information of a recording whose onset times and static frictions are unknown. Empty where the
/// model has no stick-slip at its speed.
std::optional<Information> information_of(const ModelEstimate& model, const RecordingPlan& recording,
                                          const Disturbance& disturbance);

/// Returns the information of a recording whose level says nothing about that of others.
PlanMatrix without_level(const PlanMatrix& information);

/// (covariance^-1 + information)^-1, also where the one has zeros (parameters held) or the other is singular.
PlanMatrix updated(const PlanMatrix& covariance, const PlanMatrix& information);

}  // namespace slipfit::predict
