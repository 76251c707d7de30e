#pragma once

// One slip of the Coulomb model in scaled form (docs/model.md section 4): time tau = w_n t, length V/w_n, so that
//   z'' + 2 zeta z' + z = 0,  z(0) = z0 = lambda - 2 zeta,  z'(0) = 1,  the slip ends at the first tau > 0 with z' = 1,
// where z is the spring force above F_k in units of k V / w_n. Templates, so that ceres::Jet gives derivatives.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace slipfit::model {

/// z and its first two derivatives at one tau.
template <class T>
struct SlipPoint {
  T z, dz, ddz;
};

/// Any damping: oscillating, critical (zeta = 1) and overdamped.
template <class T>
SlipPoint<T> slip_point(const T& z0, const T& zeta, const T& tau) {
  using std::cos, std::exp, std::expm1, std::sin, std::sqrt;
  T c, s;  // exp(-zeta tau) cos b tau and exp(-zeta tau) sin(b tau) / b
  if (zeta < 1.0) {
    const T b = sqrt(1.0 - zeta * zeta);
    const T decay = exp(-zeta * tau);
    c = decay * cos(b * tau);
    s = decay * sin(b * tau) / b;
  } else {
    const T beta = sqrt(zeta * zeta - 1.0);
    const T slow = exp(-tau / (zeta + beta));  // zeta - beta without cancellation; no overflow however long
    const T spread = expm1(-2.0 * beta * tau);
    c = slow * (1.0 + 0.5 * spread);
    s = beta > 0.0 ? T(-0.5 * slow * spread / beta) : T(slow * tau);
  }
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

/// In the plane of z and (z' + zeta z) / b a slip runs along a spiral of radius exp(-zeta tau) and angle b tau, and
/// starts and ends on the line z' = 1. There, with y = -z, radius^2 b^2 = 1 - 2 zeta y + y^2 =: exp(2 h) and the angle
/// is atan2(-b y, 1 - zeta y), so that the end of slip is the root of one function of h alone, docs/model.md eq. (7):
///   G(h) = h - h_start + (zeta / b) (2 pi + angle(h) - angle_start),   dG/dh = (y - 2 zeta) / (y - zeta)
/// G is all but straight in h, and y has full relative precision however short the stick.
class SpiralEnd {
 public:
  SpiralEnd(double z0, double zeta) : zeta_(zeta), b_(std::sqrt(1.0 - zeta * zeta)), loss_angle_(std::asin(zeta)) {
    const double lambda = z0 + 2.0 * zeta;
    start_h_ = 0.5 * std::log1p(lambda * z0);
    start_angle_ = std::atan2(b_ * z0, 1.0 + zeta * z0);
  }

  [[nodiscard]] double b() const { return b_; }
  [[nodiscard]] double start_angle() const { return start_angle_; }

  /// Size of z where z' = 0: the force peak is the first such state of the spiral (half_turns = 0), the trough the
  /// next.
  [[nodiscard]] double extreme(int half_turns) const {
    const double angle = (0.5 + half_turns) * std::numbers::pi - loss_angle_;
    return std::exp(start_h_ - zeta_ / b_ * (angle - start_angle_));
  }

  /// G at the smallest sliding speed (y = 2 zeta): below 0 the speed has been through 0 before.
  [[nodiscard]] bool resticks() const { return excess(0.0, -2.0 * loss_angle_) < 0.0; }

  /// y at the end of slip; `angle` becomes the angle there.
  double solve(double& angle) const {
    double low = 0.0;
    double high = zeta_ >= 0.0 ? start_h_ : start_h_ - 2.0 * kTurn * zeta_ / b_;
    // The angle of an undamped end; grazing ends are parabolas in y, which Newton's steps would meet slowly from afar.
    double h = std::clamp(start_h_ - zeta_ / b_ * (kTurn - 2.0 * start_angle_), low, high);
    constexpr int kMaxSteps = 80;  // bisection alone needs 53 halvings to reach the last bit
    double y = 0.0;
    for (int step = 0; step < kMaxSteps; ++step) {
      y = y_at(h);
      angle = std::atan2(-b_ * y, 1.0 - zeta_ * y);
      const double g = excess(h, angle);
      (g < 0.0 ? low : high) = h;
      const double change = -g * (y - zeta_) / (y - 2.0 * zeta_);
      double next = h + change;
      if (!(next >= low && next <= high)) next = 0.5 * (low + high);
      const bool settled = std::abs(next - h) <= 1e-8 * std::abs(h);  // the next error is its square
      const bool stuck = next == h;
      h = next;
      if (settled) {
        angle -= b_ / (y - zeta_) * change;
        return y_at(h);
      }
      if (stuck) break;
    }
    return y;
  }

 private:
  static constexpr double kTurn = 2.0 * std::numbers::pi;

  [[nodiscard]] double excess(double h, double angle) const {
    return h - start_h_ + zeta_ / b_ * (kTurn + angle - start_angle_);
  }
  [[nodiscard]] double y_at(double h) const { return zeta_ + std::sqrt(zeta_ * zeta_ + std::expm1(2.0 * h)); }

  double zeta_;
  double b_;
  double loss_angle_;  ///< asin zeta: by how much extremes of z lead the quarter turns
  double start_h_ = 0.0;
  double start_angle_ = 0.0;
};

/// End of slip: the only time between the largest and the smallest sliding speed, both in closed form, with z' = 1.
/// Needs lambda = z0 + 2 zeta > 0 and zeta > -1.
inline Slip solve_slip(double z0, double zeta) {
  if (zeta >= 1.0) {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    return {z0, zeta, 0.0, kNever, false, {0.0, 0.0, 0.0}};
  }
  const SpiralEnd spiral(z0, zeta);
  Slip slip{z0, zeta, spiral.b(), 0.0, spiral.resticks(), {}};
  if (!slip.resticks) {
    slip.tau_end = tau_of_fastest_slip(z0, zeta, slip.b) + std::numbers::pi / slip.b;
    slip.end = slip_point(z0, zeta, slip.tau_end);
    return slip;
  }
  double angle = 0.0;
  const double y = spiral.solve(angle);
  slip.tau_end = (2.0 * std::numbers::pi + angle - spiral.start_angle()) / slip.b;
  slip.end = {-y, 1.0, y - 2.0 * zeta};
  return slip;
}

/// SpiralEnd::extreme for any number type.
template <class T>
T slip_extreme(const T& z0, const T& zeta, int half_turns) {
  using std::asin, std::atan2, std::exp, std::log1p, std::sqrt;
  const T b = sqrt(1.0 - zeta * zeta);
  const T start_h = 0.5 * log1p((z0 + 2.0 * zeta) * z0);
  const T start_angle = atan2(b * z0, 1.0 + zeta * z0);
  const T angle = (0.5 + half_turns) * std::numbers::pi - asin(zeta);
  return exp(start_h - zeta / b * (angle - start_angle));
}

/// One slip and the stick after it in the units above, where slips repeat; peak and trough of z.
template <class T>
struct ScaledCycle {
  T slip, stick, peak, trough;
};

/// Returns that cycle with derivatives (T: ceres::Jet); it is empty where the slip does not stick again. Needs z0 + 2
/// zeta > 0 and |zeta| < 1.
template <class T>
std::optional<ScaledCycle<T>> coulomb_cycle(const T& z0, const T& zeta) {
  const Slip slip = solve_slip(z0.a, zeta.a);
  if (!slip.resticks) return std::nullopt;
  // One Newton step in dual numbers gives the moving end; z' = 1 there, so z moves with it one to one.
  const SlipPoint<T> at = slip_point(z0, zeta, T(slip.tau_end));
  T tau_end = -(at.dz - 1.0) / at.ddz;
  T z_end = at.z + tau_end;
  tau_end.a = slip.tau_end;  // the values that the spiral gives to the last digits
  z_end.a = slip.end.z;
  return ScaledCycle<T>{tau_end, z0 - z_end, slip_extreme(z0, zeta, 0), -slip_extreme(z0, zeta, 1)};
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
  double d_log_omega = 0.0;    ///< at fixed tau: only where something else than the slip has a time of its own
  double d_log_average = 0.0;  ///< by the time over which the instrument averages; 0 on a straight stick
};

/// The slip itself, 0 <= tau <= tau_end, from c = exp(-zeta tau) cos b tau and s = exp(-zeta tau) sin(b tau) / b.
inline WavePoint slip_wave(const Slip& slip, double tau, double c, double s) {
  const double bend = (slip.z0 + slip.zeta) / (slip.b * slip.b);
  return {slip.z0 * c + (1.0 + slip.zeta * slip.z0) * s, c + slip.zeta * s, bend * (s - tau * c) - tau * s,
          c - (slip.z0 + slip.zeta) * s};
}

inline WavePoint slip_wave(const Slip& slip, double tau) {
  const double decay = std::exp(-slip.zeta * tau);
  return slip_wave(slip, tau, decay * std::cos(slip.b * tau), decay * std::sin(slip.b * tau) / slip.b);
}

/// The slip as the drive or the sample side feels it: z + 2 zeta z' (docs/model.md section 7). In stick z' = 1.
inline WavePoint transmitted_wave(const Slip& slip, double tau, double c, double s) {
  const WavePoint spring = slip_wave(slip, tau, c, s);
  const double bend = slip.zeta * (slip.z0 + slip.zeta) / (slip.b * slip.b);
  const double ddz_dzeta = bend * (tau * c - s) - s - tau * c + (slip.z0 + 2.0 * slip.zeta) * tau * s;  // d z' / d zeta
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
