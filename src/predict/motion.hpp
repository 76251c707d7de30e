#pragma once

#include "predict/delta.hpp"

namespace slipfit::predict {

/// By the Coulomb tier, or the velocity tier where `model` has a `speed_dependence`; where static friction ages, with
/// that of the limit cycle. speed > 0.
MotionJets motion_at(const ModelEstimate& model, double speed_m_per_s);

CriticalPoint critical_point(const ModelEstimate& model, const Propagation& propagation);

}  // namespace slipfit::predict
