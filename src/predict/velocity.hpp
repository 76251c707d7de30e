#pragma once

// Predictions with friction that depends on the sliding speed. docs/model.md section 5

#include "predict/delta.hpp"

namespace slipfit::predict {

/// As motion_at(), for a model with `speed_dependence`.
MotionJets velocity_motion_at(const ModelEstimate& model, double speed_m_per_s);

/// As critical_point(): the highest speed at which the slip that starts from stick sticks again.
CriticalPoint velocity_critical_point(const ModelEstimate& model, const Propagation& propagation);

}  // namespace slipfit::predict
