#pragma once

#include "predict/delta.hpp"

namespace slipfit::predict {

/// As motion_at(), for a model under Coulomb friction without `ageing`.
MotionJets coulomb_motion_at(const ModelEstimate& model, double speed_m_per_s);

/// As critical_point(), likewise.
CriticalPoint coulomb_critical_point(const ModelEstimate& model, const Propagation& propagation);

}  // namespace slipfit::predict
