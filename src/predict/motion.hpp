#pragma once

#include <functional>
#include <string>

#include "model/ageing.hpp"

#include "predict/delta.hpp"

namespace slipfit::predict {

/// Returns the motion by the Coulomb tier, or by the velocity tier where `model` has a `speed_dependence`; where static
/// friction ages, with that of the limit cycle. The speed must be above 0. `sharp` is the relative error of that static
/// friction.
MotionJets motion_at(const ModelEstimate& model, double speed_m_per_s, double sharp = model::kSharpDifference);

/// Returns the critical point with what a sweep does not determine at speeds outside its own. It is unknown far outside
/// them where the recordings show no trend of static friction, or where it rests on one law of F_k(v) of several that
/// would fit.
CriticalPoint critical_point(const ModelEstimate& model);

/// Returns the critical point over the models that the covariance allows, for use where linear propagation is not
/// valid. `why` says that it is not, or has nothing to say; it is the answer where the models do not determine more.
/// `end_m_per_s` is the end of `model` itself, infinite or 0 where it has none. `end_quantile_m_per_s` gives the speed
/// below which this share of those models ends stick-slip.
CriticalPoint by_draws(const ModelEstimate& model, const std::string& why, double end_m_per_s,
                       const std::function<double(double share)>& end_quantile_m_per_s);

/// Does what motion_at() does, for a model with `speed_dependence`: docs/model.md section 5.
MotionJets velocity_motion_at(const ModelEstimate& model, double speed_m_per_s);

/// Does what critical_point() does for the velocity tier: the highest speed at which the slip that starts from stick
/// sticks again.
CriticalPoint velocity_critical_point(const ModelEstimate& model, const Propagation& propagation);

/// Does what motion_at() does, for a model under Coulomb friction without `ageing`.
MotionJets coulomb_motion_at(const ModelEstimate& model, double speed_m_per_s);

/// Returns the speed at which a model under Coulomb friction ends stick-slip: infinite where stick-slip has no end, 0
/// for a model without stick-slip.
double coulomb_end_m_per_s(const ModelEstimate& model);

/// Does what critical_point() does, for a model under Coulomb friction without `ageing`.
CriticalPoint coulomb_critical_point(const ModelEstimate& model, const Propagation& propagation);

/// Does what motion_at() does, for a model with `ageing`; the static friction of the limit cycle is found to a share of
/// `sharp`.
MotionJets ageing_motion_at(const ModelEstimate& model, double speed_m_per_s, double sharp = model::kSharpDifference);

/// Does what coulomb_end_m_per_s() does, for a model with `ageing`, to a share of `sharp`.
double ageing_end_m_per_s(const ModelEstimate& model, double sharp);

/// Does what critical_point() does, for a model with `ageing`: the sticks become too short there to give the static
/// friction that they need.
CriticalPoint ageing_critical_point(const ModelEstimate& model, const Propagation& propagation);

/// F_s - F_k(0+) of the limit cycle at a speed, for a model with `ageing`; empty where there is no stick-slip.
std::optional<double> aged_difference_N(const ModelEstimate& model, double speed_m_per_s,
                                        double sharp = model::kSharpDifference);

}  // namespace slipfit::predict
