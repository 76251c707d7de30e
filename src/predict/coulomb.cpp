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
Body body_of(const ModelEstimate& model) {
  auto slider = Slider::create(model.stiffness_N_per_m, model.natural_frequency_rad_per_s, model.damping_ratio);
  auto friction = Friction::create(model.friction_difference_N, 0.0);
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

/// The body that moves as a body on a spring that relaxes does in a slip; the same body where the spring does not
/// relax.
ModelEstimate in_slip(ModelEstimate model) {
  if (!model.relaxing) return model;
  const auto [omega, zeta] = model::relaxed_oscillator(model.damping_ratio, model.relaxing->share,
                                                       model.natural_frequency_rad_per_s * model.relaxing->time_s);
  model.stiffness_N_per_m *= omega * omega;
  model.natural_frequency_rad_per_s *= omega;
  model.damping_ratio = zeta;
  return model;
}
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
  const Jet unit_N = p.stiffness_N_per_m * speed_m_per_s / p.omega_rad_per_s;
  const Jet z0 = p.difference_N / unit_N - 2.0 * p.damping_ratio;
  const Jet time = p.omega_rad_per_s * p.relaxation_time_s;
  const auto limit = model::relaxing_period(z0.a, p.damping_ratio.a, p.relaxation.a, time.a);
  if (!limit) return std::nullopt;
  const auto of = [&](const model::RelaxingSlip::Column& column) {
    return model::composed(column, z0, p.damping_ratio, p.relaxation, time);
  };
  const Jet slip_s = of(limit->slip) / p.omega_rad_per_s;
  const Jet period_s = of(limit->period) / p.omega_rad_per_s;
  return CycleJets{slip_s,      period_s - slip_s,         period_s, speed_m_per_s * period_s,
                   z0 * unit_N, of(limit->trough) * unit_N};
}

}  // namespace

double coulomb_end_m_per_s(const ModelEstimate& model) {
  const ModelEstimate body = in_slip(model);
  if (!(body.damping_ratio > 0.0)) return HUGE_VAL;
  if (body.damping_ratio >= 1.0) return 0.0;
  // docs/model.md (6)
  return body.natural_frequency_rad_per_s * body.friction_difference_N /
         (body.stiffness_N_per_m * critical_lambda(body.damping_ratio));
}

CriticalPoint coulomb_critical_point(const ModelEstimate& model, const Propagation& propagation) {
  if (!model.damping_identified) {
    std::vector<double> ends;
    for (const ModelEstimate& draw : draws_of(model)) ends.push_back(coulomb_end_m_per_s(draw));
    return by_draws(model, "the damping ratio cannot be distinguished from 0", coulomb_end_m_per_s(model),
                    [&](double share) { return quantile_of(ends, share); });
  }
  if (!(in_slip(model).damping_ratio > 0.0)) {
    return {{0.0, std::nullopt, std::nullopt, {}}, unknown("without damping there is stick-slip at every speed")};
  }
  if (in_slip(model).damping_ratio >= 1.0) {
    const std::string reason = "no stick-slip at any speed: the damping ratio is not below 1";
    return {unknown(reason), {0.0, std::nullopt, std::nullopt, reason}};
  }
  const ModelJets p = jets_in_slip(model);
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
  const auto [slider, friction] = body_of(in_slip(model));
  const ModelJets p = jets_in_slip(model);
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
