#include "predict/motion.hpp"

#include <cassert>
#include <cmath>
#include <utility>
#include <vector>

#include "core/quantile.hpp"
#include "model/relaxing.hpp"
#include "model/slip.hpp"
#include "predict/draws.hpp"
#include "slipfit/model/sensitivity.hpp"

namespace slipfit::predict {
namespace {

struct Body {
  Slider slider;
  Friction friction;
};

/// Returns the body with F_k = 0: only the difference matters here.
Body body_of(const ModelJets& p) {
  auto slider = Slider::create(p.stiffness_N_per_m.a, p.omega_rad_per_s.a, p.damping_ratio.a);
  auto friction = Friction::create(p.difference_N.a, 0.0);
  assert(slider && friction);
  return {std::move(slider).value(), std::move(friction).value()};
}

/// From derivatives with respect to the parameters to those with respect to their logarithms. At F_k = 0 the static
/// friction is the difference.
Jet jet_of(const Sensitive& quantity, const ModelEstimate& model) {
  Jet jet(quantity.value);
  jet.v[0] = quantity.gradient[kStiffness] * model.stiffness_N_per_m;
  jet.v[1] = quantity.gradient[kNaturalFrequency] * model.natural_frequency_rad_per_s;
  jet.v[2] = quantity.gradient[kDampingRatio];
  jet.v[3] = quantity.gradient[kStaticFriction] * model.friction_difference_N;
  return jet;
}

/// Returns the elastic body that moves in a slip as a body on a spring that relaxes; the same body where the spring
/// does not relax.
ModelJets jets_in_slip(const ModelEstimate& model) {
  ModelJets p(model);
  if (!model.relaxing) return p;
  const auto [omega, zeta] =
      model::relaxed_oscillator(p.damping_ratio, p.relaxation, p.omega_rad_per_s * p.relaxation_time_s);
  p.stiffness_N_per_m *= omega * omega;
  p.omega_rad_per_s *= omega;
  p.damping_ratio = zeta;
  return p;
}

std::optional<CycleJets> relaxing_cycle(const ModelEstimate& model, double speed_m_per_s) {
  const ModelJets p(model);
  const model::RelaxingBody<Jet> body{p.stiffness_N_per_m, p.omega_rad_per_s, p.damping_ratio,
                                      p.difference_N,      p.relaxation,      p.relaxation_time_s};
  const auto limit = body.cycle_at(speed_m_per_s);
  if (!limit) return std::nullopt;
  return CycleJets{limit->slip_s,   limit->period_s - limit->slip_s,
                   limit->period_s, speed_m_per_s * limit->period_s,
                   limit->peak_N,   limit->trough_N};
}

}  // namespace

double coulomb_end_m_per_s(const ModelEstimate& model) {
  const ModelJets p = jets_in_slip(model);
  if (!(p.damping_ratio.a > 0.0)) return HUGE_VAL;
  if (p.damping_ratio.a >= 1.0) return 0.0;
  // docs/model.md (6)
  return p.omega_rad_per_s.a * p.difference_N.a / (p.stiffness_N_per_m.a * critical_lambda(p.damping_ratio.a));
}

CriticalPoint coulomb_critical_point(const ModelEstimate& model, const Propagation& propagation) {
  if (!model.damping_identified) {
    std::vector<double> ends;
    for (const ModelEstimate& draw : draws_of(model)) ends.push_back(coulomb_end_m_per_s(draw));
    return by_draws(model, "the damping ratio cannot be distinguished from 0", coulomb_end_m_per_s(model),
                    [&](double share) { return quantile_of(ends, share); });
  }
  const ModelJets p = jets_in_slip(model);
  if (!(p.damping_ratio.a > 0.0)) {
    return {{0.0, std::nullopt, std::nullopt, {}}, unknown("without damping there is stick-slip at every speed")};
  }
  if (p.damping_ratio.a >= 1.0) {
    const std::string reason = "no stick-slip at any speed: the damping ratio is not below 1";
    return {unknown(reason), {0.0, std::nullopt, std::nullopt, reason}};
  }
  const double solution = critical_lambda(p.damping_ratio.a);
  // One Newton step in dual numbers: derivatives of the root by the implicit function theorem.
  const ceres::Jet<double, 1> at(solution, 0);
  const double slope = model::restick_margin(at, ceres::Jet<double, 1>(p.damping_ratio.a)).v[0];
  const Jet critical = Jet(solution) - model::restick_margin(Jet(solution), p.damping_ratio) / slope;
  // V_c = w_n (F_s - F_k) / (k lambda_c). docs/model.md (6)
  Jet speed = p.omega_rad_per_s * p.difference_N / (p.stiffness_N_per_m * critical);
  if (!model.relaxing) return {propagation.positive(critical), propagation.positive(speed)};
  // The oscillator of the slip is near the exact end, and changes as that does.
  const ModelJets spring(model);
  const Jet slip_speed = spring.omega_rad_per_s * spring.difference_N / spring.stiffness_N_per_m;
  const double exact = model::relaxing_critical_lambda(model.damping_ratio, model.relaxing->share,
                                                       model.natural_frequency_rad_per_s * model.relaxing->time_s,
                                                       slip_speed.a / speed.a);
  speed *= slip_speed.a / exact / speed.a;
  return {propagation.positive(slip_speed / speed), propagation.positive(speed)};
}

MotionJets coulomb_motion_at(const ModelEstimate& model, double speed_m_per_s) {
  const ModelJets p = jets_in_slip(model);
  const auto [slider, friction] = body_of(p);
  MotionJets motion;
  motion.regime = damped_motion(slider, friction, speed_m_per_s).regime;
  motion.total_damping_ratio = p.damping_ratio;
  const Jet lambda = p.omega_rad_per_s * p.difference_N / (p.stiffness_N_per_m * speed_m_per_s);
  if (p.damping_ratio.a < 1.0) motion.restick_margin = model::restick_margin(lambda, p.damping_ratio);
  if (model.relaxing) {
    motion.cycle = relaxing_cycle(model, speed_m_per_s);
  } else if (const std::optional<CycleSensitivity> cycle = damped_sensitivity(slider, friction, speed_m_per_s)) {
    const CycleJets straight{jet_of(cycle->slip_s, model),       jet_of(cycle->stick_s, model),
                             jet_of(cycle->period_s, model),     jet_of(cycle->periodic_displacement_m, model),
                             jet_of(cycle->force_peak_N, model), jet_of(cycle->force_trough_N, model)};
    motion.cycle = reloaded(straight, model, speed_m_per_s);
  }
  return motion;
}

}  // namespace slipfit::predict
