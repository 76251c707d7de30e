#include "predict/motion.hpp"

#include "predict/ageing.hpp"
#include "predict/coulomb.hpp"
#include "predict/velocity.hpp"

namespace slipfit::predict {

CriticalPoint critical_point(const ModelEstimate& model, const Propagation& propagation) {
  if (model.ageing) return ageing_critical_point(model, propagation);
  if (model.speed_dependence) return velocity_critical_point(model, propagation);
  return coulomb_critical_point(model, propagation);
}

MotionJets motion_at(const ModelEstimate& model, double speed_m_per_s) {
  if (model.ageing) return ageing_motion_at(model, speed_m_per_s);
  if (model.speed_dependence) return velocity_motion_at(model, speed_m_per_s);
  return coulomb_motion_at(model, speed_m_per_s);
}

}  // namespace slipfit::predict
