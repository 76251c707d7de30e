#pragma once

#include "predict/delta.hpp"

namespace slipfit::predict {

/// As motion_at(), for a model with `ageing`.
MotionJets ageing_motion_at(const ModelEstimate& model, double speed_m_per_s);

/// As critical_point(), for a model with `ageing`: where the sticks become too short to give the static friction that
/// they need.
CriticalPoint ageing_critical_point(const ModelEstimate& model, const Propagation& propagation);

/// F_s - F_k(0+) of the limit cycle at a speed, for a model with `ageing`; empty where there is no stick-slip.
std::optional<double> aged_difference_N(const ModelEstimate& model, double speed_m_per_s);

}  // namespace slipfit::predict
