#pragma once

#include <Eigen/Dense>
#include <optional>

#include "slipfit/fit/fit.hpp"
#include "slipfit/predict/plan.hpp"

namespace slipfit::predict {

using ModelMatrix = Eigen::Matrix<double, static_cast<int>(kModelValues), static_cast<int>(kModelValues)>;

/// White noise of a sample and scatter of the static friction; 0: the static friction is the same in all cycles.
struct Disturbance {
  double noise_rms_N = 0.0;
  double static_friction_sd_N = 0.0;
};

struct Information {
  ModelMatrix matrix = ModelMatrix::Zero();  ///< about ModelEstimate's values, in the order of its covariance
  double cycles = 0.0;
  double samples_per_slip = 0.0;
};

/// Fisher information of a recording whose force level, onset times and static frictions are unknown. Empty where the
/// model has no stick-slip at its speed.
std::optional<Information> information_of(const ModelEstimate& model, const RecordingPlan& recording,
                                          const Disturbance& disturbance);

/// (covariance^-1 + information)^-1, also where the one has zeros (parameters held) or the other is singular.
ModelMatrix updated(const ModelMatrix& covariance, const ModelMatrix& information);

}  // namespace slipfit::predict
