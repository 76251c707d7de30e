#include "fit/observation/sensor.hpp"

#include <cmath>

namespace slipfit::fit {

SensedSlip::SensedSlip(const Sensor& sensor, const model::Slip& slip)
    : sensor_(sensor),
      z0_(slip.z0, 0),
      zeta_(slip.zeta, 1),
      b_(sqrt(1.0 - zeta_ * zeta_)),
      end_tau_(model::slip_end(slip, z0_, zeta_)),
      half_(0.5 * sensor.average_tau),
      z_sine_((1.0 + zeta_ * z0_) / b_),
      slope_sine_((z0_ + zeta_) / b_),
      end_(in_slip(phase_at(end_tau_))) {
  half_.v[3] = half_.a;
  if (!(sensor.lag_tau > 0.0)) return;
  kappa_.a = 1.0 / sensor.lag_tau;  // kappa = 1 / (w_n T)
  kappa_.v[3] = -kappa_.a;
  // The same kind of oscillation solves the sensor's equation; an exponential joins it to the lagging ramp before.
  const Jet rest = kappa_ - zeta_;
  const Jet scale = kappa_ / (rest * rest + b_ * b_);
  lag_cosine_ = scale * (rest * z0_ - b_ * z_sine_);
  lag_sine_ = scale * (rest * z_sine_ + b_ * z0_);
  lag_rest_ = z0_ - 1.0 / kappa_ - lag_cosine_;
  lag_end_ = lagged_in_slip(end_tau_);
}

SensedSlip::Phase SensedSlip::phase_at(const Jet& tau) const {
  const Jet decay = -zeta_ * tau;
  const Jet turn = b_ * tau;
  const double size = std::exp(decay.a);
  Phase phase{Jet(size * std::cos(turn.a)), Jet(size * std::sin(turn.a))};
  phase.c.v = decay.v * phase.c.a - turn.v * phase.s.a;
  phase.s.v = decay.v * phase.s.a + turn.v * phase.c.a;
  return phase;
}

/// z'' + 2 zeta z' + z = 0 gives the integral of z over the slip: 1 + 2 zeta z0 - z' - 2 zeta z.
SensedSlip::Force SensedSlip::in_slip(const Phase& phase) const {
  const Jet z = z0_ * phase.c + z_sine_ * phase.s;
  const Jet slope = phase.c - slope_sine_ * phase.s;
  return {z, slope, 1.0 + 2.0 * zeta_ * (z0_ - z) - slope};
}

SensedSlip::Force SensedSlip::force_at(const Jet& tau) const {
  if (tau.a <= 0.0) return {z0_ + tau, Jet(1.0), tau * (z0_ + 0.5 * tau)};
  if (tau.a <= end_tau_.a) return in_slip(phase_at(tau));
  const Jet since = tau - end_tau_;
  return {end_.z + since, Jet(1.0), end_.integral + since * (end_.z + 0.5 * since)};
}

SensedSlip::Jet SensedSlip::lagged_in_slip(const Jet& tau) const {
  const Phase phase = phase_at(tau);
  return lag_cosine_ * phase.c + lag_sine_ * phase.s + lag_rest_ * exp(-kappa_ * tau);
}

SensedSlip::Jet SensedSlip::lagged_at(const Jet& tau) const {
  if (tau.a <= 0.0) return z0_ + tau - 1.0 / kappa_;
  if (tau.a <= end_tau_.a) return lagged_in_slip(tau);
  const Jet since = tau - end_tau_;
  return end_.z + since - 1.0 / kappa_ + (lag_end_ - end_.z + 1.0 / kappa_) * exp(-kappa_ * since);
}

/// Returns the force as the sensor shows it before it is averaged, with its slope and (but for a constant) its
/// integral: y' = kappa (z - y) makes the integral of y that of z less y / kappa.
SensedSlip::Force SensedSlip::shown_at(const Jet& tau) const {
  Force y = force_at(tau);
  if (sensor_.lag_tau > 0.0) {
    const Jet lagged = lagged_at(tau);
    y = {lagged, kappa_ * (y.z - lagged), y.integral - lagged / kappa_};
  }
  if (!sensor_.transmitted) return y;
  // The drag's part is 2 zeta z', and the sensor shows of z' the slope of what it shows of z.
  return {y.z + 2.0 * zeta_ * y.slope, y.slope, y.integral + 2.0 * zeta_ * y.z};
}

model::WavePoint SensedSlip::at(double tau) const {
  const Jet at(tau, 2);
  if (!(sensor_.average_tau > 0.0)) {
    const Jet y = shown_at(at).z;
    return {y.a, y.v[0], y.v[1], y.v[2], y.v[3]};
  }
  const Force first = shown_at(at - half_);
  const Force last = shown_at(at + half_);
  const Jet y = (last.integral - first.integral) / (2.0 * half_);
  return {y.a, y.v[0], y.v[1], y.v[2], y.v[3], 0.5 * (first.z.a + last.z.a) - y.a};
}

}  // namespace slipfit::fit
