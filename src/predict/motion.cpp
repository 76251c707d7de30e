#include "predict/motion.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "core/fit_thresholds.hpp"
#include "core/unknown.hpp"

namespace slipfit::predict {
namespace {

CriticalPoint critical_point_by_law(const ModelEstimate& model) {
  const Propagation propagation(model);
  if (model.ageing) return ageing_critical_point(model, propagation);
  if (model.speed_dependence) return velocity_critical_point(model, propagation);
  return coulomb_critical_point(model, propagation);
}

}  // namespace

CriticalPoint critical_point(const ModelEstimate& model) {
  CriticalPoint point = critical_point_by_law(model);
  const std::optional<double> speed = point.speed_m_per_s.value;
  if (!speed || !(*speed > 0.0) || !model.reach) return point;
  const double distance = model.reach->distance_to(*speed);
  const std::optional<ModelEstimate> wider = beyond(model, *speed);
  if (!wider) {
    point.speed_m_per_s = unknown(kUntrended);
  } else if ((model.speed_dependence || model.ageing) && distance > std::log(thresholds::kUntrendedRatio)) {
    point.speed_m_per_s =
        unknown(fmt::format("the law of {} friction puts it at {:.4g} m/s, a factor of {:.2g} beyond the recordings: "
                            "another law that fits them as well puts it elsewhere",
                            model.ageing ? "static" : "kinetic", *speed, std::exp(distance)));
  } else {
    return critical_point_by_law(*wider);
  }
  return point;
}

MotionJets motion_at(const ModelEstimate& model, double speed_m_per_s) {
  if (model.ageing) return ageing_motion_at(model, speed_m_per_s);
  if (model.speed_dependence) return velocity_motion_at(model, speed_m_per_s);
  return coulomb_motion_at(model, speed_m_per_s);
}

}  // namespace slipfit::predict
