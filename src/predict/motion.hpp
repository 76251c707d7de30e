#pragma once

#include <functional>
#include <string>

#include "model/ageing.hpp"

#include "predict/delta.hpp"

namespace slipfit::predict {

/// By the Coulomb tier, or the velocity tier where `model` has a `speed_dependence`; where static friction ages, with
/// that of the limit cycle. speed > 0.
/// `sharp`: relative error of that static friction.
MotionJets motion_at(const ModelEstimate& model, double speed_m_per_s, double sharp = model::kSharpDifference);

/// With what a sweep does not know of speeds beyond its own. Unknown far beyond them where the recordings show no trend
/// of static friction, or where it rests on one law of F_k(v) of several that would fit.
CriticalPoint critical_point(const ModelEstimate& model);

/// Over the models that the covariance allows, for where linear propagation does not hold. `why`: it does not, or has
/// nothing to say; the answer where they do not tell more. `end_m_per_s`: of `model` itself, infinite or 0 where it has
/// none. `end_quantile_m_per_s`: the speed below which this share of those models ends stick-slip.
CriticalPoint by_draws(const ModelEstimate& model, const std::string& why, double end_m_per_s,
                       const std::function<double(double share)>& end_quantile_m_per_s);

/// As motion_at(), for a model with `speed_dependence`: docs/model.md section 5.
MotionJets velocity_motion_at(const ModelEstimate& model, double speed_m_per_s);

/// As critical_point(): the highest speed at which the slip that starts from stick sticks again.
CriticalPoint velocity_critical_point(const ModelEstimate& model, const Propagation& propagation);

/// As motion_at(), for a model under Coulomb friction without `ageing`.
MotionJets coulomb_motion_at(const ModelEstimate& model, double speed_m_per_s);

/// Where a model under Coulomb friction ends stick-slip: infinite where it has no end, 0 where there is none.
double coulomb_end_m_per_s(const ModelEstimate& model);

/// As critical_point(), likewise.
CriticalPoint coulomb_critical_point(const ModelEstimate& model, const Propagation& propagation);

/// As motion_at(), for a model with `ageing`; the static friction of the limit cycle to a share of `sharp`.
MotionJets ageing_motion_at(const ModelEstimate& model, double speed_m_per_s, double sharp = model::kSharpDifference);

/// As coulomb_end_m_per_s(), for a model with `ageing`: to a share of `sharp`.
double ageing_end_m_per_s(const ModelEstimate& model, double sharp);

/// As critical_point(), for a model with `ageing`: where the sticks become too short to give the static friction that
/// they need.
CriticalPoint ageing_critical_point(const ModelEstimate& model, const Propagation& propagation);

/// F_s - F_k(0+) of the limit cycle at a speed, for a model with `ageing`; empty where there is no stick-slip.
std::optional<double> aged_difference_N(const ModelEstimate& model, double speed_m_per_s,
                                        double sharp = model::kSharpDifference);

}  // namespace slipfit::predict
