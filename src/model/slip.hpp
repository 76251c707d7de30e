#pragma once

// One slip of the Coulomb model in scaled form (docs/model.md section 4): time tau = w_n t, length V/w_n, so that
//   z'' + 2 zeta z' + z = 0,  z(0) = z0 = lambda - 2 zeta,  z'(0) = 1,  the slip ends at the first tau > 0 with z' = 1,
// where z is the spring force above F_k in units of k V / w_n. Templates, so that ceres::Jet gives derivatives.

#include <algorithm>
#include <cmath>
#include <numbers>

namespace slipfit::model {

/// z and its first two derivatives at one tau.
template <class T>
struct SlipPoint {
  T z, dz, ddz;
};

template <class T>
SlipPoint<T> slip_point(const T& z0, const T& zeta, const T& tau) {
  using std::cos, std::exp, std::sin, std::sqrt;
  const T b = sqrt(1.0 - zeta * zeta);
  const T decay = exp(-zeta * tau);
  const T c = decay * cos(b * tau);
  const T s = decay * sin(b * tau) / b;
  const T z = z0 * c + (1.0 + zeta * z0) * s;
  const T dz = c - (z0 + zeta) * s;
  return {z, dz, -2.0 * zeta * dz - z};
}

/// A slip solved in double: when it ends, whether it does, and the closed-form derivatives that the fit needs.
struct Slip {
  double z0 = 0.0;
  double zeta = 0.0;
  double b = 1.0;        ///< sqrt(1 - zeta^2)
  double tau_end = 0.0;  ///< end of slip; where it never sticks again: the minimum of the sliding speed
  bool resticks = false;
  SlipPoint<double> end{};
};

/// z'' = 0 at the largest sliding speed (and, half a damped period later, at the smallest).
inline double tau_of_fastest_slip(double z0, double zeta, double b) {
  const double lambda = z0 + 2.0 * zeta;
  return std::atan2(b * lambda, zeta * lambda - 1.0) / b;
}

/// End of slip: the only root of z' = 1 between the largest and the smallest sliding speed, both in closed form.
/// Needs lambda = z0 + 2 zeta > 0 and |zeta| < 1.
inline Slip solve_slip(double z0, double zeta) {
  Slip slip{z0, zeta, std::sqrt(1.0 - zeta * zeta), 0.0, false, {}};
  double low = tau_of_fastest_slip(z0, zeta, slip.b);
  double high = low + std::numbers::pi / slip.b;
  const SlipPoint<double> slowest = slip_point(z0, zeta, high);
  slip.tau_end = high;
  slip.end = slowest;
  if (slowest.dz < 1.0) return slip;
  slip.resticks = true;

  // Start: z' = exp(-zeta tau) R cos(b tau + phi), with the decay taken at the undamped end of slip.
  const double q = (z0 + zeta) / slip.b;
  const double phi = std::atan(q);
  const double undamped_end = 2.0 * (std::numbers::pi - phi) / slip.b;
  const double cosine = std::min(1.0, std::exp(zeta * undamped_end) / std::hypot(1.0, q));
  double tau = (2.0 * std::numbers::pi - phi - std::acos(cosine)) / slip.b;
  constexpr int kMaxSteps = 60;  // bisection alone needs 53 halvings to reach the last bit
  for (int step = 0; step < kMaxSteps; ++step) {
    if (!(tau > low && tau < high)) tau = 0.5 * (low + high);
    slip.end = slip_point(z0, zeta, tau);
    const double excess = slip.end.dz - 1.0;  // < 0 while sliding
    (excess < 0.0 ? low : high) = tau;
    const double newton = tau - excess / slip.end.ddz;
    if (std::abs(newton - tau) <= 2e-16 * tau || high - low <= 2e-16 * high) break;
    tau = newton;
  }
  slip.tau_end = tau;
  slip.end = slip_point(z0, zeta, tau);
  return slip;
}

/// End of slip with derivatives: one Newton step in T from the solution in double (implicit function theorem). Where
/// the slip does not stick again, the same for the minimum of the sliding speed (z'' = 0).
template <class T>
T slip_end(const Slip& slip, const T& z0, const T& zeta) {
  const SlipPoint<T> at = slip_point(z0, zeta, T(slip.tau_end));
  if (slip.resticks) return T(slip.tau_end) - (at.dz - 1.0) / at.ddz;
  const T dddz = -2.0 * zeta * at.ddz - at.dz;
  return T(slip.tau_end) - at.ddz / dddz;
}

/// > 0 where a slip that starts from stick sticks again: ln(1 + lambda^2 - 2 zeta lambda) against the damping of the
/// turn (docs/model.md section 4). zeta in (0, 1).
template <class T>
T restick_margin(const T& lambda, const T& zeta) {
  using std::atan2, std::log1p, std::sqrt;
  const T b = sqrt(1.0 - zeta * zeta);
  return log1p(lambda * (lambda - 2.0 * zeta)) -
         2.0 * zeta / b * (2.0 * std::numbers::pi - atan2(b * lambda, 1.0 - zeta * lambda));
}

/// Force of the whole cycle above F_k at tau (negative: the stick before the slip) in units of k V / w_n, spring view,
/// with derivatives with respect to z0, zeta (at fixed tau) and tau. z' is the transmitted view's extra term / 2 zeta.
struct WavePoint {
  double z = 0.0, d_z0 = 0.0, d_zeta = 0.0, d_tau = 0.0;
};

/// The slip itself, 0 <= tau <= tau_end.
inline WavePoint slip_wave(const Slip& slip, double tau) {
  const double decay = std::exp(-slip.zeta * tau);
  const double c = decay * std::cos(slip.b * tau);
  const double s = decay * std::sin(slip.b * tau) / slip.b;
  const double g = c + slip.zeta * s;  // d z / d z0
  const double ds_dzeta = -tau * s + slip.zeta / (slip.b * slip.b) * (s - tau * c);
  const double dg_dzeta = -tau * c + (1.0 + slip.zeta * tau) * s + slip.zeta * ds_dzeta;
  // z = z0 g + s and z' = c - (z0 + zeta) s
  return {slip.z0 * g + s, g, slip.z0 * dg_dzeta + ds_dzeta, c - (slip.z0 + slip.zeta) * s};
}

/// The slip as the drive or the sample side feels it: z + 2 zeta z' (docs/model.md section 7). In stick z' = 1.
inline WavePoint transmitted_wave(const Slip& slip, double tau) {
  const WavePoint spring = slip_wave(slip, tau);
  const double decay = std::exp(-slip.zeta * tau);
  const double c = decay * std::cos(slip.b * tau);
  const double s = decay * std::sin(slip.b * tau) / slip.b;
  const double ds_dzeta = -tau * s + slip.zeta / (slip.b * slip.b) * (s - tau * c);
  const double ddz_dzeta = tau * (slip.zeta * s - c) - s - (slip.z0 + slip.zeta) * ds_dzeta;  // d z' / d zeta
  const double drag = 2.0 * slip.zeta;
  const double ddz = -drag * spring.d_tau - spring.z;  // z''
  return {spring.z + drag * spring.d_tau, spring.d_z0 - drag * s, spring.d_zeta + 2.0 * spring.d_tau + drag * ddz_dzeta,
          spring.d_tau + drag * ddz};
}

/// The straight line z = intercept + tau that follows the slip; derivatives of the intercept.
struct StickLine {
  double intercept = 0.0, d_z0 = 0.0, d_zeta = 0.0;
};

/// A slip that sticks again joins its ramp with equal slope (z' = 1): the moving end adds nothing to first order.
inline StickLine stick_after(const Slip& slip) {
  const WavePoint end = slip_wave(slip, slip.tau_end);
  StickLine line{end.z - slip.tau_end, end.d_z0, end.d_zeta};
  if (slip.resticks) return line;
  // tau_end is where z'' = 0: b tau = atan2(b lambda, zeta lambda - 1) + pi moves with z0 and zeta.
  const double lambda = slip.z0 + 2.0 * slip.zeta;
  const double x = slip.zeta * lambda - 1.0;
  const double y = slip.b * lambda;
  const double db = -slip.zeta / slip.b;
  const double norm2 = x * x + y * y;
  const double dtheta_dlambda = (x * slip.b - y * slip.zeta) / norm2;
  const double dtheta_dzeta = (x * db * lambda - y * lambda) / norm2;
  const double dtau_dz0 = dtheta_dlambda / slip.b;
  const double dtau_dzeta = (dtheta_dzeta + 2.0 * dtheta_dlambda) / slip.b - slip.tau_end * db / slip.b;
  const double slope_step = end.d_tau - 1.0;
  line.d_z0 += slope_step * dtau_dz0;
  line.d_zeta += slope_step * dtau_dzeta;
  return line;
}

}  // namespace slipfit::model
