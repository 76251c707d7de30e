#pragma once

#include <optional>
#include <string>
#include <vector>

#include "slipfit/core/result.hpp"
#include "slipfit/fit/result.hpp"
#include "slipfit/predict/recording_plan.hpp"

namespace slipfit {

/// States whether the recordings share one force level, F_k(0+) relative to the zero of the sensor; if so, the level
/// also determines F_k(V).
enum class LevelSharing { Shared, Separate };

/// The starting point of a plan.
struct PlanBasis {
  ModelEstimate estimate;                 ///< with its covariance
  std::vector<RecordingPlan> recordings;  ///< that it was fitted to; at least one
  double noise_rms_N = 0.0;               ///< of a sample, > 0
  std::optional<double> force_drop_sd_N;  ///< scatter of the fall of the force in a slip, from cycle to cycle
  LevelSharing levels = LevelSharing::Separate;
};

/// The quantity whose interval a plan reduces: a parameter, or the spacing at a speed.
struct PlanTarget {
  std::string name;                     ///< JSON key of a parameter, or "periodic_displacement_m"
  std::optional<double> speed_m_per_s;  ///< of the spacing
};

/// The effect that limits the accuracy of a parameter.
enum class Limit {
  Noise,     ///< of the samples
  Scatter,   ///< of the static friction from cycle to cycle
  Sampling,  ///< too few samples in a slip
  Cycles,    ///< noise and scatter alike: only more cycles help
  Misfit,    ///< the interval is wider than noise and scatter explain: cycles or recordings disagree with the model
  Held       ///< by the user
};

struct ParameterLimit {
  std::string name;
  double value = 0.0;
  double standard_error = 0.0;
  double explained_error = 0.0;  ///< that noise and scatter alone would leave
  Limit limit = Limit::Cycles;
};

/// An additional recording, and the standard error of the target with it.
struct PlanOption {
  RecordingPlan recording;
  double cycles = 0.0;
  double samples_per_slip = 0.0;
  double standard_error = 0.0;
};

struct Plan {
  PlanTarget target;
  double value = 0.0;
  double standard_error = 0.0;         ///< now
  std::vector<ParameterLimit> limits;  ///< all parameters of the model
  std::vector<PlanOption> options;     ///< one a speed, best first, each as long as the recordings were
  std::optional<double> halving_s;     ///< duration of the best option that halves the standard error
};

/// Recommends the next recording. The standard errors of the fit are scaled by the ratio in which Fisher information
/// reduces those calculated for its recordings, with white noise of the same density, scatter of the same size, and
/// individual onset and static friction in each cycle. The error is bad_target if the model does not contain the
/// target, the fit fixed it, or there is no stick-slip at the speed of the spacing.
Result<Plan> plan_next(const PlanBasis& basis, const std::optional<PlanTarget>& target);

}  // namespace slipfit
