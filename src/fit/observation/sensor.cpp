#include "fit/observation/sensor.hpp"

#include <ceres/jet.h>

#include <utility>

namespace slipfit::fit {
namespace {

/// Derivatives with respect to z0, zeta, tau, ln w_n.
using Jet = ceres::Jet<double, 4>;

/// Force, its derivative and its integral from the onset on.
struct Force {
  Jet z, slope, integral;
};

struct Cycle {
  const model::Slip& slip;
  Jet z0, zeta;
  Jet end_tau{};
  model::SlipPoint<Jet> end{};

  Cycle(const model::Slip& of_slip, Jet of_z0, Jet of_zeta)
      : slip(of_slip), z0(std::move(of_z0)), zeta(std::move(of_zeta)) {
    end_tau = model::slip_end(slip, z0, zeta);
    end = model::slip_point(z0, zeta, end_tau);
  }

  /// z'' + 2 zeta z' + z = 0 gives the integral of z over the slip: 1 + 2 zeta z0 - z' - 2 zeta z.
  [[nodiscard]] Force at(const Jet& tau) const {
    if (tau.a <= 0.0) return {z0 + tau, Jet(1.0), tau * (z0 + 0.5 * tau)};
    const Jet begin = 1.0 + 2.0 * zeta * z0;
    if (tau.a <= slip.tau_end) {
      const model::SlipPoint<Jet> p = model::slip_point(z0, zeta, tau);
      return {p.z, p.dz, begin - p.dz - 2.0 * zeta * p.z};
    }
    const Jet since = tau - end_tau;
    return {end.z + since, Jet(1.0), begin - end.dz - 2.0 * zeta * end.z + since * (end.z + 0.5 * since)};
  }
};

/// In the slip z = exp(-zeta tau) (P cos b tau + Q sin b tau). The same kind of oscillation solves the sensor's
/// equation; an exponential joins it to the lagging ramp before.
Jet lagged_in_slip(const Cycle& cycle, const Jet& kappa, const Jet& tau) {
  const Jet b = sqrt(1.0 - cycle.zeta * cycle.zeta);
  const Jet& p = cycle.z0;
  const Jet q = (1.0 + cycle.zeta * cycle.z0) / b;
  const Jet rest = kappa - cycle.zeta;
  const Jet scale = kappa / (rest * rest + b * b);
  const Jet r = scale * (rest * p - b * q);
  const Jet s = scale * (rest * q + b * p);
  const Jet c = exp(-cycle.zeta * tau) * cos(b * tau);
  const Jet d = exp(-cycle.zeta * tau) * sin(b * tau);
  return r * c + s * d + (cycle.z0 - 1.0 / kappa - r) * exp(-kappa * tau);
}

Jet lagged_at(const Cycle& cycle, const Jet& kappa, const Jet& tau) {
  if (tau.a <= 0.0) return cycle.z0 + tau - 1.0 / kappa;
  if (tau.a <= cycle.slip.tau_end) return lagged_in_slip(cycle, kappa, tau);
  const Jet end = lagged_in_slip(cycle, kappa, cycle.end_tau);
  const Jet since = tau - cycle.end_tau;
  return cycle.end.z + since - 1.0 / kappa + (end - cycle.end.z + 1.0 / kappa) * exp(-kappa * since);
}

/// As the sensor shows it before it is averaged, and (but for a constant) the integral of that: y' = kappa (z - y)
/// makes the integral of y that of z less y / kappa.
Force shown_at(const Cycle& cycle, const Jet* kappa, bool transmitted, const Jet& tau) {
  Force y = cycle.at(tau);
  if (kappa != nullptr) {
    const Jet lagged = lagged_at(cycle, *kappa, tau);
    y = {lagged, *kappa * (y.z - lagged), y.integral - lagged / *kappa};
  }
  if (!transmitted) return y;
  // The drag's part is 2 zeta z', and the sensor shows of z' the slope of what it shows of z.
  return {y.z + 2.0 * cycle.zeta * y.slope, y.slope, y.integral + 2.0 * cycle.zeta * y.z};
}

}  // namespace

model::WavePoint Sensor::wave_at(const model::Slip& slip, double tau) const {
  const Cycle cycle(slip, Jet(slip.z0, 0), Jet(slip.zeta, 1));
  Jet kappa(lag_tau > 0.0 ? 1.0 / lag_tau : 0.0);
  kappa.v[3] = -kappa.a;  // kappa = 1 / (w_n T)
  const Jet* const lag = lag_tau > 0.0 ? &kappa : nullptr;
  const Jet at(tau, 2);
  Jet y;
  if (average_tau > 0.0) {
    Jet half(0.5 * average_tau);
    half.v[3] = half.a;
    const Force first = shown_at(cycle, lag, transmitted, at - half);
    const Force last = shown_at(cycle, lag, transmitted, at + half);
    y = (last.integral - first.integral) / (2.0 * half);
  } else {
    y = shown_at(cycle, lag, transmitted, at).z;
  }
  return {y.a, y.v[0], y.v[1], y.v[2], y.v[3]};
}

}  // namespace slipfit::fit
