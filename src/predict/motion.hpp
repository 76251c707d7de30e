#pragma once

#include "predict/delta.hpp"

namespace slipfit::predict {

/// By the Coulomb tier, or the velocity tier where `model` has a `speed_dependence`; where static friction ages, with
/// that of the limit cycle. speed > 0.
MotionJets motion_at(const ModelEstimate& model, double speed_m_per_s);

/// With what a sweep does not know of speeds beyond its own. Unknown far beyond them where the recordings show no trend
/// of static friction, or where it rests on one law of F_k(v) of several that would fit.
CriticalPoint critical_point(const ModelEstimate& model);

}  // namespace slipfit::predict
