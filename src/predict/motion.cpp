#include "predict/motion.hpp"

namespace slipfit::predict {

ModelMotion motion_at(const ModelEstimate& model, double speed_m_per_s, double sharp) {
  model::SlidingBody<Jet> body = body_at<Jet>(model, speed_m_per_s);
  // Where each slip is smaller than the one before, nothing sticks in the end: as for F_s = F_k.
  body.difference_N = body.aged_difference_N(sharp).value_or(Jet(0.0));
  ModelMotion motion;
  motion.cycle = body.cycle();
  motion.lambda = motion.cycle ? body.lambda() : body_at<Jet>(model, speed_m_per_s).lambda();
  motion.total_damping_ratio = body.total_damping_ratio();
  motion.regime = body.regime(motion.cycle.has_value());
  // With ageing the margin is needed, not enough: the cycle ends sooner.
  if (motion.cycle || !body.ageing) motion.restick_margin = body.restick_margin();
  return motion;
}

bool sticks_at(const ModelEstimate& model, double speed_m_per_s, double sharp) {
  return body_at<Plain>(model, speed_m_per_s).sticks(sharp);
}

}  // namespace slipfit::predict
