#include "slipfit/predict/single_speed.hpp"

#include <cassert>
#include <cstddef>
#include <utility>

#include "core/fit_thresholds.hpp"

namespace slipfit {

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

}  // namespace slipfit
