#pragma once

#include <optional>

#include "predict/delta.hpp"

namespace slipfit::predict {

/// The motion of a model at one speed, above 0.
struct ModelMotion {
  Regime regime = Regime::ContinuousSlip;
  Jet lambda;  ///< SlidingBody::lambda, where static friction ages that after the sticks of this speed
  std::optional<model::SlidingCycle<Jet>> cycle;  ///< empty: no stick-slip
  std::optional<Jet> restick_margin;              ///< SlidingBody::restick_margin
  Jet total_damping_ratio;                        ///< SlidingBody::total_damping_ratio
};

/// Returns that motion; where static friction ages with that of the limit cycle, to a share of `sharp`.
ModelMotion motion_at(const ModelEstimate& model, double speed_m_per_s, double sharp = model::kSharpDifference);

/// Returns whether a model has stick-slip at a speed; where static friction ages by that of the limit cycle, to a share
/// of `sharp`.
bool sticks_at(const ModelEstimate& model, double speed_m_per_s, double sharp = model::kSharpDifference);

}  // namespace slipfit::predict
