#include "predict/motion.hpp"

#include "core/fit_thresholds.hpp"
#include "model/slip_jets.hpp"
#include "model/velocity_units.hpp"

namespace slipfit::predict {
namespace {

using SlipJets = model::SlipJets<Jet>;

SlipJets slip_at(const ModelJets& p, double speed_m_per_s) {
  return {p.stiffness_N_per_m, p.omega_rad_per_s, p.damping_ratio, p.difference_N,
          p.slope_N_s_per_m,   p.alpha_s_per_m,   speed_m_per_s};
}

/// Force where z' passes 0 between two times; to first order it does not move with that time.
Jet extreme(const SlipJets& slip, const model::VelocityTrack& track, double before, double after) {
  const bool rises = track.at(before).d_tau > 0.0;
  constexpr int kHalvings = 50;  // to round-off
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (before + after);
    ((track.at(middle).d_tau > 0.0) == rises ? before : after) = middle;
  }
  const model::TrackPoint point = track.at(before);
  return slip.force_unit_N * slip.jet(point.z, point);
}

/// Returns the cycle; empty where the slip does not stick, or ends with the force above that of the next slip's start.
std::optional<CycleJets> cycle_of(const SlipJets& slip, const model::VelocityTrack& track, const Jet& omega,
                                  double speed_m_per_s) {
  if (!track.resticks()) return std::nullopt;
  const Jet tau_slip = slip.tau_slip(track.end());
  const Jet tau_period = slip.tau_period(track);
  if (!(tau_period.a > tau_slip.a)) return std::nullopt;
  // The force is largest soon after the slip has started and smallest soon before it ends: between those two it falls.
  const double falling = track.fastest_tau();
  const Jet period_s = tau_period / omega;
  return CycleJets{
      tau_slip / omega,         (tau_period - tau_slip) / omega,    period_s,
      speed_m_per_s * period_s, extreme(slip, track, 0.0, falling), extreme(slip, track, falling, track.tau_end())};
}

/// Positive where the slip sticks: z''^2 at its end is linear in the parameters up to where it vanishes; without stick
/// what z' lacks to 1.
Jet margin_of(const SlipJets& slip, const model::VelocityTrack& track) {
  const model::TrackEnd& end = track.end();
  const Jet first = slip.jet(end.first);
  if (!track.resticks()) return first - 1.0;
  Jet margin(end.second.value * end.second.value);
  margin.v = 2.0 * (end.second.value * slip.jet(end.second).v - end.third * first.v);
  return margin;
}

bool sticks_at(const ModelJets& p, double speed_m_per_s) {
  const auto track = slip_at(p, speed_m_per_s).solve();
  return track && track->resticks();
}

/// Two speeds with nothing between them: the slip sticks at the lower one and at no higher speed looked at.
struct Bracket {
  double sticks = 0.0, slides = 0.0;
};

/// In units of the speed of a slip, (F_s - F_k) w_n / k: lambda from 1000 down to 1/300. Damping of 3e-6 ends
/// stick-slip there, less than any recording shows.
constexpr double kSlowest = 1e-3;
constexpr double kFastest = 300.0;
constexpr double kSearchStep = 1.1;

Bracket refined(const ModelJets& p, Bracket bracket) {
  constexpr double kSharp = 1e-13;
  while (bracket.slides - bracket.sticks > kSharp * bracket.slides) {
    const double middle = 0.5 * (bracket.sticks + bracket.slides);
    (sticks_at(p, middle) ? bracket.sticks : bracket.slides) = middle;
  }
  return bracket;
}

}  // namespace

MotionJets velocity_motion_at(const ModelEstimate& model, double speed_m_per_s) {
  const ModelJets p(model);
  const SlipJets slip = slip_at(p, speed_m_per_s);
  MotionJets motion;
  // Linearised at the driving speed: tangent of the friction law, not its chord. docs/model.md section 5
  motion.total_damping_ratio = slip.zeta + 0.5 * slip.slope * exp(slip.rate);
  if (const auto track = slip.solve()) {
    motion.cycle = cycle_of(slip, *track, p.omega_rad_per_s, speed_m_per_s);
    if (motion.cycle) motion.cycle = reloaded(*motion.cycle, model, speed_m_per_s);
    motion.restick_margin = margin_of(slip, *track);
  }
  motion.regime = model::regime_of(motion.total_damping_ratio.a, motion.cycle.has_value());
  return motion;
}

CriticalPoint velocity_critical_point(const ModelEstimate& model, const Propagation& propagation) {
  const ModelJets p(model);
  const double unit = (p.omega_rad_per_s * p.difference_N / p.stiffness_N_per_m).a;
  double speed = kFastest * unit;
  if (sticks_at(p, speed)) {
    if (!model.damping_identified) return CriticalPoint::unknown("the damping ratio cannot be distinguished from 0");
    return {{0.0, std::nullopt, std::nullopt, {}}, unknown("there is stick-slip at every speed looked at")};
  }
  while (speed > kSlowest * unit && !sticks_at(p, speed / kSearchStep)) speed /= kSearchStep;
  if (speed <= kSlowest * unit) return CriticalPoint::unknown("no stick-slip at any speed");
  const double critical = refined(p, {speed / kSearchStep, speed}).slides;
  const SlipJets slip = slip_at(p, critical);
  const auto track = slip.solve();
  if (!track || track->resticks()) return CriticalPoint::unknown("the end of stick-slip has no solution");
  // The largest z' is 1 there: derivatives of the root by the implicit function theorem.
  const model::TrackValue& first = track->end().first;
  const double by_speed = (-first.d_z0 * (slip.z0.a + 2.0 * slip.zeta.a) + first.d_rate * slip.rate.a) / critical;
  Jet speed_jet(critical);
  speed_jet.v = -slip.jet(first).v / by_speed;
  if (propagation.quantile() * propagation.standard_error(speed_jet) > std::log(thresholds::kWidestFactor) * critical ||
      propagation.law_is_open_at(critical)) {
    return CriticalPoint::unknown("damping and friction law are not known well enough to tell where stick-slip ends");
  }
  const Jet lambda = p.omega_rad_per_s * p.difference_N / (p.stiffness_N_per_m * speed_jet);
  return {propagation.positive(lambda), propagation.positive(speed_jet)};
}

}  // namespace slipfit::predict
