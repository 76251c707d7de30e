#include "fit/observation/sensor_lag.hpp"

#include <ceres/jet.h>

namespace slipfit::fit {
namespace {

/// Derivatives with respect to z0, zeta, tau, ln w_n.
using Jet = ceres::Jet<double, 4>;

struct Shown {
  Jet z;  ///< the force itself
  Jet y;  ///< what the sensor shows
};

/// In the slip z = exp(-zeta tau) (P cos b tau + Q sin b tau). The same kind of oscillation solves the sensor's
/// equation; an exponential joins it to the lagging ramp before.
Shown in_slip(const Jet& z0, const Jet& zeta, const Jet& kappa, const Jet& tau) {
  const Jet b = sqrt(1.0 - zeta * zeta);
  const Jet& p = z0;
  const Jet q = (1.0 + zeta * z0) / b;
  const Jet rest = kappa - zeta;
  const Jet scale = kappa / (rest * rest + b * b);
  const Jet r = scale * (rest * p - b * q);
  const Jet s = scale * (rest * q + b * p);
  const Jet c = exp(-zeta * tau) * cos(b * tau);
  const Jet d = exp(-zeta * tau) * sin(b * tau);
  return {p * c + q * d, r * c + s * d + (z0 - 1.0 / kappa - r) * exp(-kappa * tau)};
}

Shown at(const model::Slip& slip, const Jet& z0, const Jet& zeta, const Jet& kappa, const Jet& tau) {
  if (tau.a <= 0.0) return {z0 + tau, z0 + tau - 1.0 / kappa};
  if (tau.a <= slip.tau_end) return in_slip(z0, zeta, kappa, tau);
  const Jet tau_end = model::slip_end(slip, z0, zeta);
  const Shown end = in_slip(z0, zeta, kappa, tau_end);
  const Jet since = tau - tau_end;
  return {end.z + since, end.z + since - 1.0 / kappa + (end.y - end.z + 1.0 / kappa) * exp(-kappa * since)};
}

}  // namespace

model::WavePoint SensorLag::wave_at(const model::Slip& slip, double tau) const {
  Jet kappa(1.0 / lag_tau);
  kappa.v[3] = -kappa.a;  // kappa = 1 / (w_n T)
  const Jet zeta(slip.zeta, 1);
  const Shown shown = at(slip, Jet(slip.z0, 0), zeta, kappa, Jet(tau, 2));
  // The drag's part is 2 zeta z', and the sensor shows of z' the slope of what it shows of z.
  const Jet y = transmitted ? shown.y + 2.0 * zeta * kappa * (shown.z - shown.y) : shown.y;
  return {y.a, y.v[0], y.v[1], y.v[2], y.v[3]};
}

}  // namespace slipfit::fit
