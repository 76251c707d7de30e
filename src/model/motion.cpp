#include "slipfit/model/motion.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "model/slip.hpp"

namespace slipfit {
namespace {

Error out_of_range(const std::string& name, double value, const std::string& expected) {
  return {"parameter_out_of_range", name + " is " + std::to_string(value) + ", expected " + expected};
}

bool is_positive(double value) {
  return std::isfinite(value) && value > 0.0;
}

}  // namespace

Result<Slider> Slider::create(double stiffness_N_per_m, double natural_frequency_rad_per_s, double damping_ratio) {
  if (!is_positive(stiffness_N_per_m)) return out_of_range("stiffness (N/m)", stiffness_N_per_m, "a number > 0");
  if (!is_positive(natural_frequency_rad_per_s)) {
    return out_of_range("natural frequency (rad/s)", natural_frequency_rad_per_s, "a number > 0");
  }
  if (!(damping_ratio >= 0.0 && damping_ratio < 1.0)) {
    return out_of_range("damping ratio", damping_ratio, "a number in [0, 1)");
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

Motion damped_motion(const Slider& slider, const Friction& friction, double speed_m_per_s) {
  const double w_n = slider.natural_frequency_rad_per_s();
  const double zeta = slider.damping_ratio();
  const double force_scale_N = slider.stiffness_N_per_m() * speed_m_per_s / w_n;
  Motion motion;
  motion.lambda = friction.difference_N() / force_scale_N;
  const double z0 = motion.lambda - 2.0 * zeta;
  const bool exists = motion.lambda > 0.0 && (zeta == 0.0 || model::restick_margin(motion.lambda, zeta) > 0.0);
  if (!exists) {
    motion.regime = Regime::OscillatorySlip;
    return motion;
  }
  motion.regime = zeta > 0.0 ? Regime::StickSlipBistable : Regime::StickSlip;

  const model::Slip slip = model::solve_slip(z0, zeta);
  // Extremes of the force in a slip: z' = 0, half a damped period apart. tan(b tau) = b / (z0 + zeta)
  const double b = slip.b;
  const double tau_peak = std::atan2(b, z0 + zeta) / b;
  LimitCycle cycle;
  cycle.slip_s = slip.tau_end / w_n;
  cycle.stick_s = (z0 - slip.end.z) / w_n;
  cycle.period_s = cycle.slip_s + cycle.stick_s;
  cycle.sticking_degree = cycle.stick_s / cycle.period_s;
  cycle.periodic_displacement_m = speed_m_per_s * cycle.period_s;
  cycle.onset_force_N = friction.kinetic_N() + force_scale_N * z0;
  cycle.end_force_N = friction.kinetic_N() + force_scale_N * slip.end.z;
  cycle.force_peak_N = friction.kinetic_N() + force_scale_N * model::slip_point(z0, zeta, tau_peak).z;
  cycle.force_trough_N =
      friction.kinetic_N() + force_scale_N * model::slip_point(z0, zeta, tau_peak + std::numbers::pi / b).z;
  motion.cycle = cycle;
  return motion;
}

}  // namespace slipfit
