#include "slipfit/model/motion.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "model/parameter_error.hpp"
#include "model/slip.hpp"

namespace slipfit {

using model::is_positive;
using model::out_of_range;

Result<Slider> Slider::create(double stiffness_N_per_m, double natural_frequency_rad_per_s, double damping_ratio) {
  if (!is_positive(stiffness_N_per_m)) return out_of_range("stiffness (N/m)", stiffness_N_per_m, "a number > 0");
  if (!is_positive(natural_frequency_rad_per_s)) {
    return out_of_range("natural frequency (rad/s)", natural_frequency_rad_per_s, "a number > 0");
  }
  if (!(std::isfinite(damping_ratio) && damping_ratio >= 0.0)) {
    return out_of_range("damping ratio", damping_ratio, "a number >= 0");
  }
  Slider slider;
  slider.stiffness_N_per_m_ = stiffness_N_per_m;
  slider.natural_frequency_rad_per_s_ = natural_frequency_rad_per_s;
  slider.damping_ratio_ = damping_ratio;
  return slider;
}

Result<Friction> Friction::create(double static_N, double kinetic_N) {
  if (!std::isfinite(kinetic_N) || kinetic_N < 0.0) {
    return out_of_range("kinetic friction (N)", kinetic_N, "a number >= 0");
  }
  if (!std::isfinite(static_N) || static_N < kinetic_N) {
    return out_of_range("static friction (N)", static_N, "a number not below the kinetic friction");
  }
  Friction friction;
  friction.static_N_ = static_N;
  friction.kinetic_N_ = kinetic_N;
  return friction;
}

double critical_lambda(double damping_ratio) {
  if (damping_ratio <= 0.0) return 0.0;
  // The margin is negative at 2 zeta (z0 = 0: no force above F_k) and grows without bound with lambda.
  double low = 2.0 * damping_ratio;
  double high = 2.0 * low + 1.0;
  while (model::restick_margin(high, damping_ratio) <= 0.0) high *= 2.0;
  while (high - low > 4.0 * std::numeric_limits<double>::epsilon() * high) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    (model::restick_margin(middle, damping_ratio) <= 0.0 ? low : high) = middle;
  }
  return high;
}

std::optional<double> critical_speed_m_per_s(const Slider& slider, const Friction& friction) {
  const double zeta = slider.damping_ratio();
  if (zeta >= 1.0) return 0.0;
  if (zeta == 0.0) return std::nullopt;
  const double fastest = slider.natural_frequency_rad_per_s() * friction.difference_N() / slider.stiffness_N_per_m();
  return fastest / critical_lambda(zeta);
}

Motion damped_motion(const Slider& slider, const Friction& friction, double speed_m_per_s) {
  const double w_n = slider.natural_frequency_rad_per_s();
  const double zeta = slider.damping_ratio();
  const double force_scale_N = slider.stiffness_N_per_m() * speed_m_per_s / w_n;
  Motion motion;
  motion.lambda = friction.difference_N() / force_scale_N;
  motion.regime = zeta < 1.0 ? Regime::OscillatorySlip : Regime::ContinuousSlip;
  if (!(motion.lambda > 0.0) || zeta >= 1.0) return motion;
  const double z0 = motion.lambda - 2.0 * zeta;
  const model::SpiralEnd spiral(z0, zeta);
  if (!spiral.resticks()) return motion;
  motion.regime = zeta > 0.0 ? Regime::StickSlipBistable : Regime::StickSlip;

  double end_angle = 0.0;
  const double y = spiral.solve(end_angle);  // z at the end of slip is -y
  const double tau_slip = (2.0 * std::numbers::pi + end_angle - spiral.start_angle()) / spiral.b();
  const double tau_stick = z0 + y;
  const auto force_N = [&](double z) { return friction.kinetic_N() + force_scale_N * z; };
  LimitCycle cycle;
  cycle.slip_s = tau_slip / w_n;
  cycle.stick_s = tau_stick / w_n;
  cycle.period_s = (tau_slip + tau_stick) / w_n;
  cycle.sticking_degree = tau_stick / (tau_slip + tau_stick);
  cycle.periodic_displacement_m = speed_m_per_s * cycle.period_s;
  cycle.onset_force_N = force_N(z0);
  cycle.end_force_N = force_N(-y);
  cycle.force_peak_N = force_N(spiral.extreme(0));
  cycle.force_trough_N = force_N(-spiral.extreme(1));
  // Slip: z = -z'' - 2 zeta z' integrates to 2 zeta (z0 - z_end). Stick: a straight line from z_end to z0.
  cycle.mean_force_N = force_N(tau_stick * (2.0 * zeta + 0.5 * (z0 - y)) / (tau_slip + tau_stick));
  motion.cycle = cycle;
  return motion;
}

}  // namespace slipfit
