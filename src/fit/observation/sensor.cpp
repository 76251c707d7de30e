#include "fit/observation/sensor.hpp"

namespace slipfit::fit {

SensedSlip::SensedSlip(const Sensor& sensor, const model::Slip& slip)
    : sensor_(sensor),
      z0_(slip.z0, 0),
      zeta_(slip.zeta, 1),
      end_tau_(model::slip_end(slip, z0_, zeta_)),
      kappa_(sensor.lag_tau > 0.0 ? 1.0 / sensor.lag_tau : 0.0),
      half_(0.5 * sensor.average_tau),
      end_(model::slip_point(z0_, zeta_, end_tau_)) {
  kappa_.v[3] = -kappa_.a;  // kappa = 1 / (w_n T)
  half_.v[3] = half_.a;
}

/// z'' + 2 zeta z' + z = 0 gives the integral of z over the slip: 1 + 2 zeta z0 - z' - 2 zeta z.
SensedSlip::Force SensedSlip::force_at(const Jet& tau) const {
  if (tau.a <= 0.0) return {z0_ + tau, Jet(1.0), tau * (z0_ + 0.5 * tau)};
  const Jet begin = 1.0 + 2.0 * zeta_ * z0_;
  if (tau.a <= end_tau_.a) {
    const model::SlipPoint<Jet> p = model::slip_point(z0_, zeta_, tau);
    return {p.z, p.dz, begin - p.dz - 2.0 * zeta_ * p.z};
  }
  const Jet since = tau - end_tau_;
  return {end_.z + since, Jet(1.0), begin - end_.dz - 2.0 * zeta_ * end_.z + since * (end_.z + 0.5 * since)};
}

/// In the slip z = exp(-zeta tau) (P cos b tau + Q sin b tau). The same kind of oscillation solves the sensor's
/// equation; an exponential joins it to the lagging ramp before.
SensedSlip::Jet SensedSlip::lagged_in_slip(const Jet& tau) const {
  const Jet b = sqrt(1.0 - zeta_ * zeta_);
  const Jet& p = z0_;
  const Jet q = (1.0 + zeta_ * z0_) / b;
  const Jet rest = kappa_ - zeta_;
  const Jet scale = kappa_ / (rest * rest + b * b);
  const Jet r = scale * (rest * p - b * q);
  const Jet s = scale * (rest * q + b * p);
  const Jet c = exp(-zeta_ * tau) * cos(b * tau);
  const Jet d = exp(-zeta_ * tau) * sin(b * tau);
  return r * c + s * d + (z0_ - 1.0 / kappa_ - r) * exp(-kappa_ * tau);
}

SensedSlip::Jet SensedSlip::lagged_at(const Jet& tau) const {
  if (tau.a <= 0.0) return z0_ + tau - 1.0 / kappa_;
  if (tau.a <= end_tau_.a) return lagged_in_slip(tau);
  const Jet end = lagged_in_slip(end_tau_);
  const Jet since = tau - end_tau_;
  return end_.z + since - 1.0 / kappa_ + (end - end_.z + 1.0 / kappa_) * exp(-kappa_ * since);
}

/// As the sensor shows it before it is averaged, and (but for a constant) the integral of that: y' = kappa (z - y)
/// makes the integral of y that of z less y / kappa.
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
  Jet y;
  if (sensor_.average_tau > 0.0) {
    y = (shown_at(at + half_).integral - shown_at(at - half_).integral) / (2.0 * half_);
  } else {
    y = shown_at(at).z;
  }
  return {y.a, y.v[0], y.v[1], y.v[2], y.v[3]};
}

}  // namespace slipfit::fit
