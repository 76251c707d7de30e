#include "predict/ageing.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "core/fit_thresholds.hpp"
#include "model/ageing.hpp"
#include "predict/coulomb.hpp"
#include "predict/velocity.hpp"

namespace slipfit::predict {
namespace {

/// The row of ModelEstimate's values that holds ln (F_s - F_k(0+)).
constexpr Eigen::Index kDifference = 3;

/// The same bodies, with static friction that does not age.
ModelEstimate held_at(const ModelEstimate& model, double difference_N) {
  ModelEstimate held = model;
  held.ageing.reset();
  held.friction_difference_N = difference_N;
  return held;
}

MotionJets held_motion_at(const ModelEstimate& held, double speed_m_per_s) {
  return held.speed_dependence ? velocity_motion_at(held, speed_m_per_s) : coulomb_motion_at(held, speed_m_per_s);
}

/// Derivative with respect to F_s - F_k(0+), taken out of a jet of `held_at`.
double take_derivative_by_difference(Jet& y, double difference_N) {
  return std::exchange(y.v(kDifference), 0.0) / difference_N;
}

/// F_s - F_k(0+) of the limit cycle and its derivatives.
Jet aged_jet(const ModelEstimate& model, double difference_N, Jet stick_s) {
  const ModelJets p = jets_of(model);
  const double by_difference = take_derivative_by_difference(stick_s, difference_N);
  return model::aged_difference_N(difference_N, p.difference_N, p.ageing_N, stick_s, by_difference,
                                  model.ageing->reference_stick_s);
}

/// How much the static friction after a stick exceeds the one that made it so long, at F_s - F_k(0+) held.
Jet excess_N(const ModelEstimate& model, double difference_N, double speed_m_per_s) {
  Jet stick_s = held_motion_at(held_at(model, difference_N), speed_m_per_s).cycle->stick_s;
  take_derivative_by_difference(stick_s, difference_N);
  const ModelJets p = jets_of(model);
  return p.difference_N + p.ageing_N * log(stick_s / model.ageing->reference_stick_s) - difference_N;
}

}  // namespace

std::optional<double> aged_difference_N(const ModelEstimate& model, double speed_m_per_s) {
  const model::AgeingLaw law{model.friction_difference_N, model.ageing->rate_N, model.ageing->reference_stick_s};
  return model::aged_difference_N(law, [&](double difference_N) -> std::optional<model::StickTime> {
    const MotionJets motion = held_motion_at(held_at(model, difference_N), speed_m_per_s);
    if (!motion.cycle) return std::nullopt;
    Jet stick_s = motion.cycle->stick_s;
    const double by_difference = take_derivative_by_difference(stick_s, difference_N);
    return model::StickTime{stick_s.a, by_difference};
  });
}

MotionJets ageing_motion_at(const ModelEstimate& model, double speed_m_per_s) {
  const std::optional<double> difference_N = aged_difference_N(model, speed_m_per_s);
  if (!difference_N) {
    // Each slip is smaller than the one before, until nothing sticks: as for F_s = F_k.
    MotionJets motion = held_motion_at(held_at(model, 0.0), speed_m_per_s);
    motion.cycle.reset();
    motion.restick_margin.reset();
    if (motion.regime == Regime::StickSlip || motion.regime == Regime::StickSlipBistable) {
      motion.regime = Regime::OscillatorySlip;
    }
    return motion;
  }
  MotionJets motion = held_motion_at(held_at(model, *difference_N), speed_m_per_s);
  const Jet aged_N = aged_jet(model, *difference_N, motion.cycle->stick_s);
  CycleJets& cycle = *motion.cycle;
  for (Jet* const y : {&cycle.slip_s, &cycle.stick_s, &cycle.period_s, &cycle.periodic_displacement_m,
                       &cycle.force_peak_N, &cycle.force_trough_N}) {
    const double by_difference = take_derivative_by_difference(*y, *difference_N);
    y->v += by_difference * aged_N.v;
  }
  motion.aged_difference_N = aged_N;
  motion.restick_margin.reset();  // the cycle ends sooner, where its stick becomes too short
  return motion;
}

CriticalPoint ageing_critical_point(const ModelEstimate& model, const Propagation& propagation) {
  constexpr double kSlowest = 1e-6;
  constexpr double kFastest = 300.0;
  constexpr double kSharp = 1e-9;
  // The speed goes as exp(-(F_s - F_k) / rate): its logarithm is nearly linear in the parameters.
  const ModelJets p = jets_of(model);
  const double unit = (p.omega_rad_per_s * p.difference_N / p.stiffness_N_per_m).a;
  double sticks = kSlowest * unit;
  double slides = kFastest * unit;
  const auto both = [](const std::string& reason) { return CriticalPoint{unknown(reason), unknown(reason)}; };
  if (!aged_difference_N(model, sticks)) return both("no stick-slip at any speed");
  if (aged_difference_N(model, slides)) return both("there is stick-slip at every speed looked at");
  while (slides > (1.0 + kSharp) * sticks) {
    const double middle = std::sqrt(sticks * slides);
    (aged_difference_N(model, middle) ? sticks : slides) = middle;
  }
  // There the excess only just reaches 0 over F_s - F_k, so that its derivative by that vanishes.
  const double difference_N = *aged_difference_N(model, sticks);
  const Jet excess = excess_N(model, difference_N, sticks);
  constexpr double kStep = 1e-4;
  const double by_speed = (excess_N(model, difference_N, sticks * (1.0 - kStep)).a - excess.a) / (-kStep * sticks);
  Jet speed(sticks);
  speed.v = -excess.v / by_speed;
  if (propagation.quantile() * propagation.standard_error(speed) > thresholds::kWidestAgeing * sticks) {
    return both("ageing and damping are not known well enough to tell where stick-slip ends");
  }
  const Jet lambda = p.omega_rad_per_s * difference_N / (p.stiffness_N_per_m * speed);
  return {propagation.positive(lambda), propagation.positive(speed)};
}

}  // namespace slipfit::predict
