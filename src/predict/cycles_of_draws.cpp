#include "predict/cycles_of_draws.hpp"

#include "core/student.hpp"
#include "predict/delta.hpp"
#include "predict/draws.hpp"
#include "predict/motion.hpp"

namespace slipfit::predict {

CyclesOfDraws::CyclesOfDraws(const ModelEstimate& model, double speed_m_per_s)
    : quantile_(t_quantile(model.degrees_of_freedom)) {
  constexpr double kRough = 1e-4;  // of static friction: its scatter over the models is what counts
  const std::vector<ModelEstimate> draws = draws_of(model);
  for (const ModelEstimate& draw : draws) {
    const ModelMotion motion = motion_at(draw, speed_m_per_s, kRough);
    if (!motion.cycle) continue;
    const double micro_m = micro_vibration_spacing_m(body_at<Jet>(draw, speed_m_per_s)).a;
    cycles_.push_back({motion.cycle->slip_s.a, motion.cycle->stick_s.a, micro_m});
  }
  if (!draws.empty()) share_ = static_cast<double>(cycles_.size()) / static_cast<double>(draws.size());
}

}  // namespace slipfit::predict
