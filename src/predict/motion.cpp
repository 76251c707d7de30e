#include "predict/motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/fit_thresholds.hpp"
#include "core/student.hpp"
#include "core/unknown.hpp"

namespace slipfit::predict {
namespace {

CriticalPoint critical_point_by_law(const ModelEstimate& model) {
  const Propagation propagation(model);
  if (model.ageing && model.relaxing) {
    return CriticalPoint::unknown(
        "the end of stick-slip is not computed for a spring that relaxes and static friction that ages");
  }
  if (model.ageing) return ageing_critical_point(model, propagation);
  if (model.speed_dependence) return velocity_critical_point(model, propagation);
  return coulomb_critical_point(model, propagation);
}

MotionJets motion_by_law(const ModelEstimate& model, double speed_m_per_s, double sharp) {
  if (model.ageing) return ageing_motion_at(model, speed_m_per_s, sharp);
  if (model.speed_dependence) return velocity_motion_at(model, speed_m_per_s);
  return coulomb_motion_at(model, speed_m_per_s);
}

/// Scales the interval of a positive quantity, which is symmetric in its logarithm.
void scale_log_interval(Estimate& estimate, double factor) {
  if (!estimate.standard_error || !estimate.ci95) return;
  *estimate.standard_error *= factor;
  estimate.ci95->low = *estimate.value * std::pow(estimate.ci95->low / *estimate.value, factor);
  estimate.ci95->high = *estimate.value * std::pow(estimate.ci95->high / *estimate.value, factor);
}

/// Returns the critical point if all that is known is that it lies above a speed: no farther outside the recordings
/// than any law is valid.
CriticalPoint bound_of(const ModelEstimate& model, double least_m_per_s) {
  const std::optional<ModelEstimate> wider = beyond(model, least_m_per_s);
  if (!wider) return CriticalPoint::unknown(kUntrended);
  CriticalPoint point = critical_point_by_law(*wider);
  std::optional<Interval>& bounds = point.speed_m_per_s.ci95;
  const bool has_law = model.speed_dependence || model.ageing;
  if (has_law && bounds && model.reach)
    bounds->low = std::min(bounds->low, thresholds::kUntrendedRatio * model.reach->fastest_m_per_s);
  return point;
}

CriticalPoint critical_point_of(const ModelEstimate& model) {
  CriticalPoint point = critical_point_by_law(model);
  const std::optional<double> speed = point.speed_m_per_s.value;
  const bool is_fitted = model.reach || model.single_speed;
  if (!speed && point.speed_m_per_s.ci95 && is_fitted) return bound_of(model, point.speed_m_per_s.ci95->low);
  if (!speed || !(*speed > 0.0) || !is_fitted) return point;
  const double distance = model.reach ? model.reach->distance_to(*speed) : 0.0;
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

}  // namespace

CriticalPoint by_draws(const ModelEstimate& model, const std::string& why, double end_m_per_s,
                       const std::function<double(double share)>& end_quantile_m_per_s) {
  constexpr std::size_t kZeta = place_in_model(ParameterId::DampingRatio);
  constexpr double kTail = 0.025;
  // Without an error zeta says nothing: it may lie anywhere.
  if (!model.damping_identified && !(model.covariance[kZeta][kZeta] > 0.0)) return CriticalPoint::unknown(why);
  const double low = end_quantile_m_per_s(kTail);
  // Where zeta may be 0, no draw is exactly that.
  const bool is_damped = model.damping_identified && model.damping_ratio > 0.0;
  const double high = is_damped ? end_quantile_m_per_s(1.0 - kTail) : HUGE_VAL;
  CriticalPoint point = CriticalPoint::unknown(why);
  if (!(low > 0.0) || std::isinf(low)) return point;
  Estimate& speed = point.speed_m_per_s;
  speed.ci95 = Interval{low, high};
  if (std::isinf(high)) return point;
  speed.value = low < end_m_per_s && end_m_per_s < high ? end_m_per_s : std::sqrt(low * high);
  speed.standard_error = 0.5 * *speed.value * std::log(high / low) / kNormalQuantile;
  speed.note.clear();
  return point;
}

CriticalPoint critical_point(const ModelEstimate& model) {
  if (!model.stiffness_trend) return critical_point_of(model);
  // By k and w_n of the speed itself: where V = g(V), and ln V moves by 1 / (1 - d ln g / d ln V) times what ln g does.
  constexpr int kMostSteps = 50;
  constexpr double kSame = 1e-12;  // of ln V
  double speed_m_per_s = model.stiffness_trend->speed_m_per_s;
  double step_before = 0.0;
  double slope = 0.0;
  for (int i = 0; i < kMostSteps; ++i) {
    CriticalPoint point = critical_point_of(at_speed(model, speed_m_per_s));
    Estimate& end = point.speed_m_per_s;
    if (!end.value || !(*end.value > 0.0)) return point;
    const double step = std::log(*end.value / speed_m_per_s);
    if (i > 0 && std::abs(step) > kSame) slope = step / step_before;
    if (std::abs(step) < kSame) {
      scale_log_interval(end, 1.0 / (1.0 - slope));
      return point;
    }
    step_before = step;
    speed_m_per_s = *end.value;
  }
  return CriticalPoint::unknown("the stiffness changes too much with the speed to tell where stick-slip ends");
}

MotionJets motion_at(const ModelEstimate& model, double speed_m_per_s, double sharp) {
  MotionJets motion = motion_by_law(at_speed(model, speed_m_per_s), speed_m_per_s, sharp);
  const auto follow = [&](Jet& y) { y = from_speed(y, model, speed_m_per_s); };
  if (motion.aged_difference_N) follow(*motion.aged_difference_N);
  if (motion.restick_margin) follow(*motion.restick_margin);
  follow(motion.total_damping_ratio);
  if (!motion.cycle) return motion;
  CycleJets& cycle = *motion.cycle;
  for (Jet* const y : {&cycle.slip_s, &cycle.stick_s, &cycle.period_s, &cycle.periodic_displacement_m,
                       &cycle.force_peak_N, &cycle.force_trough_N}) {
    follow(*y);
  }
  return motion;
}

}  // namespace slipfit::predict
