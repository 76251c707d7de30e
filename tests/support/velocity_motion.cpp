#include "support/velocity_motion.hpp"

#include <ceres/jet.h>

#include <algorithm>
#include <cmath>

#include "model/parameter_error.hpp"
#include "model/velocity_slip.hpp"
#include "model/velocity_units.hpp"

namespace slipfit {

using model::is_positive;

namespace {

/// The instants that matter: s is largest and smallest where v = 1.
struct SlipPath {
  model::SlipOutcome outcome = model::SlipOutcome::NotSolved;
  model::SlipNode peak, trough, end;
};

template <bool kWithGradient>
SlipPath path_of(const model::ScaledSlip& slip) {
  SlipPath path;
  const auto keep_extremes = [&path](const model::SlipWalker<kWithGradient>& walker) {
    if (walker.from.state.v < 1.0 && walker.to.state.v >= 1.0) {
      path.peak = node_at_speed(walker, 1.0, walker.to);
    }
    if (falls_below_drive(walker)) path.trough = node_at_speed(walker, 1.0, walker.to);
  };
  const model::SlipEnd last = model::follow_slip<kWithGradient>(slip, model::kExact, keep_extremes);
  path.outcome = last.outcome;
  path.end = last.node;
  return path;
}

LimitCycle limit_cycle(const model::SpeedUnits& units, const SlipPath& path, const Slider& slider,
                       const VelocityFriction& friction, double speed_m_per_s) {
  const double w_n = slider.natural_frequency_rad_per_s();
  const double zeta = slider.damping_ratio();
  const double s_end = path.end.state.s;
  const double tau_stick = units.slip.lambda - s_end;
  const double tau_period = path.end.tau + tau_stick;
  // s = z + 2 zeta; the integral of s over the stick, a straight line from s_end to lambda
  const double stick_integral = 0.5 * tau_stick * (units.slip.lambda + s_end);
  const auto force_N = [&](double s) { return friction.onset_N() + units.force_N * (s - 2.0 * zeta); };
  LimitCycle cycle;
  cycle.slip_s = path.end.tau / w_n;
  cycle.stick_s = tau_stick / w_n;
  cycle.period_s = tau_period / w_n;
  cycle.sticking_degree = tau_stick / tau_period;
  cycle.periodic_displacement_m = speed_m_per_s * cycle.period_s;
  cycle.onset_force_N = force_N(units.slip.lambda);
  cycle.end_force_N = force_N(s_end);
  cycle.force_peak_N = force_N(path.peak.state.s);
  cycle.force_trough_N = force_N(path.trough.state.s);
  cycle.mean_force_N = force_N((path.end.integral + stick_integral) / tau_period);
  return cycle;
}

std::optional<double> stability_speed_m_per_s(const Slider& slider, const VelocityFriction& friction) {
  const double slope_at_rest = friction.alpha_s_per_m() * friction.f1_N();
  // c + alpha f1 exp(alpha V) = 0
  const double speed_m_per_s = std::log(-slider.damping_N_s_per_m() / slope_at_rest) / friction.alpha_s_per_m();
  return is_positive(speed_m_per_s) ? std::optional(speed_m_per_s) : std::nullopt;
}

}  // namespace

Result<VelocityMotion> velocity_motion(const Slider& slider, const VelocityFriction& friction, double speed_m_per_s) {
  const Result<model::SpeedUnits> in_units = model::in_speed_units(slider, friction, speed_m_per_s);
  if (!in_units) return in_units.error();
  const model::ScaledSlip& slip = in_units.value().slip;
  const auto path = path_of<false>(slip);
  if (path.outcome == model::SlipOutcome::NotSolved) return model::no_convergence(slip);
  VelocityMotion result;
  result.motion.lambda = slip.lambda;
  const bool sticks = path.outcome == model::SlipOutcome::Resticks;
  if (sticks) result.motion.cycle = limit_cycle(in_units.value(), path, slider, friction, speed_m_per_s);
  result.total_damping_ratio = slip.total_damping_ratio();
  result.motion.regime = model::regime_of(result.total_damping_ratio, sticks);
  result.stability_speed_m_per_s = stability_speed_m_per_s(slider, friction);
  return result;
}

namespace {

using Jet = ceres::Jet<double, static_cast<int>(kVelocityParameters)>;

Jet jet(double value, VelocityParameter parameter) {
  return {value, static_cast<int>(parameter)};
}

VelocityDerivative derivative(const Jet& x) {
  VelocityDerivative result;
  result.value = x.a;
  std::copy_n(x.v.data(), kVelocityParameters, result.gradient.begin());
  return result;
}

/// Derivatives with respect to the scaled parameters become ones with respect to the model's.
class ChainRule {
 public:
  ChainRule(const Slider& slider, const VelocityFriction& friction, double speed_m_per_s)
      : w_n(jet(slider.natural_frequency_rad_per_s(), VelocityParameter::NaturalFrequency)),
        zeta(jet(slider.damping_ratio(), VelocityParameter::DampingRatio)),
        speed(jet(speed_m_per_s, VelocityParameter::Speed)),
        scale_N(jet(slider.stiffness_N_per_m(), VelocityParameter::Stiffness) * speed / w_n) {
    const Jet f0 = jet(friction.f0_N(), VelocityParameter::F0);
    const Jet f1 = jet(friction.f1_N(), VelocityParameter::F1);
    onset_N = f0 + f1;
    lambda = (jet(friction.static_N(), VelocityParameter::StaticFriction) - onset_N) / scale_N;
    const Jet rate = jet(friction.alpha_s_per_m(), VelocityParameter::Alpha) * speed;
    scaled_ = {lambda - 2.0 * zeta, zeta, f1 / scale_N * rate, rate};
  }

  /// A scaled quantity by its value and its derivatives.
  [[nodiscard]] Jet quantity(double value, const double* by_scaled) const {
    Jet result(value);
    for (std::size_t p = 0; p < model::kScaledParameters; ++p) result.v += by_scaled[p] * scaled_[p].v;
    return result;
  }
  [[nodiscard]] Jet force_N(const Jet& s) const { return onset_N + scale_N * (s - 2.0 * zeta); }

  Jet w_n, zeta, speed, scale_N, onset_N, lambda;

 private:
  std::array<Jet, model::kScaledParameters> scaled_;
};

}  // namespace

Result<std::optional<VelocityDerivatives>> velocity_derivatives(const Slider& slider, const VelocityFriction& friction,
                                                                double speed_m_per_s) {
  using Answer = std::optional<VelocityDerivatives>;
  const Result<model::SpeedUnits> in_units = model::in_speed_units(slider, friction, speed_m_per_s);
  if (!in_units) return in_units.error();
  const auto path = path_of<true>(in_units.value().slip);
  if (path.outcome == model::SlipOutcome::NotSolved) return model::no_convergence(in_units.value().slip);
  if (path.outcome != model::SlipOutcome::Resticks) return Answer();

  const ChainRule chain(slider, friction, speed_m_per_s);
  const auto s_at = [&](const model::SlipNode& node) { return chain.quantity(node.state.s, node.state.ds.data()); };
  // v(tau, p) = 0 moves the end by -dv/dp / v'; s' = 1 there, so s moves with it one to one.
  const Jet v_end = chain.quantity(0.0, path.end.state.dv.data());
  const Jet tau_end = Jet(path.end.tau) - v_end / path.end.acceleration;
  const Jet s_end = s_at(path.end) - v_end / path.end.acceleration;
  const Jet slip_s = tau_end / chain.w_n;
  const Jet stick_s = (chain.lambda - s_end) / chain.w_n;
  const Jet period_s = slip_s + stick_s;
  return Answer(VelocityDerivatives{
      derivative(slip_s), derivative(stick_s), derivative(period_s), derivative(chain.speed * period_s),
      derivative(chain.force_N(chain.lambda)), derivative(chain.force_N(s_end)),
      derivative(chain.force_N(s_at(path.peak))),  // s' = 0 at both extremes: their times add nothing
      derivative(chain.force_N(s_at(path.trough)))});
}

Result<VelocityWaveform> velocity_waveform(const Slider& slider, const VelocityFriction& friction, double speed_m_per_s,
                                           std::span<const double> slip_time_s) {
  const Result<model::SpeedUnits> in_units = model::in_speed_units(slider, friction, speed_m_per_s);
  if (!in_units) return in_units.error();
  const double w_n = slider.natural_frequency_rad_per_s();
  model::SlipTrace trace(in_units.value().slip);
  VelocityWaveform waveform;
  for (const double time_s : slip_time_s) {
    const std::optional<model::TracePoint> point = trace.at(w_n * time_s);
    if (!point) return model::no_convergence(in_units.value().slip);
    waveform.spring_force_N.push_back(friction.onset_N() +
                                      in_units.value().force_N * (point->s - 2.0 * slider.damping_ratio()));
    waveform.sliding_speed_m_per_s.push_back(speed_m_per_s * point->v);
  }
  if (trace.tau_end()) waveform.slip_s = *trace.tau_end() / w_n;
  return waveform;
}

}  // namespace slipfit
