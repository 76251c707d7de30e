#pragma once

#include <optional>
#include <string>
#include <vector>

#include "slipfit/core/result.hpp"
#include "slipfit/fit/fit.hpp"

namespace slipfit {

/// How a recording was made, or would be.
struct RecordingPlan {
  double speed_m_per_s = 0.0;
  double sample_rate_Hz = 0.0;
  double duration_s = 0.0;
};

/// What a plan starts from.
struct PlanBasis {
  ModelEstimate estimate;                      ///< with its covariance
  std::vector<RecordingPlan> recordings;       ///< that it was fitted to; at least one
  double noise_rms_N = 0.0;                    ///< of a sample, > 0
  std::optional<double> static_friction_sd_N;  ///< scatter from cycle to cycle
};

/// What shall become narrower: a parameter, or the spacing at a speed.
struct PlanTarget {
  std::string name;                     ///< JSON key of a parameter, or "periodic_displacement_m"
  std::optional<double> speed_m_per_s;  ///< of the spacing
};

/// What keeps a parameter from being known better.
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
  Limit limit = Limit::Cycles;
};

/// One more recording, and the standard error of the target with it.
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

/// Which recording to make next, by Fisher information: the fit's own covariance, and white noise and scatter of the
/// same size in the recording to come, whose force level, onsets and static frictions are its own. Errors: a target
/// that the model does not have, or a spacing at a speed without stick-slip.
Result<Plan> plan_next(const PlanBasis& basis, const std::optional<PlanTarget>& target);

}  // namespace slipfit
