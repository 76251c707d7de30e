#include "model/weakening.hpp"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace slipfit::model {
namespace {

double value_of(double x) {
  return x;
}
template <int N>
double value_of(const ceres::Jet<double, N>& x) {
  return x.a;
}

/// Slip x with its first two derivatives and its integral.
template <class T>
struct Slide {
  T x, v, a, integral;
};

/// x'' + 2 zeta x' - g x = tau from rest by the power series of x, where the closed form takes differences of nearly
/// equal numbers: |g| tau^2 <= 1. Its terms alternate as those of exp(-2 zeta tau), to 2e-12 of x at 2 zeta tau = 10.
template <class T>
Slide<T> slide_by_series(const T& g, const T& zeta, const T& tau) {
  using std::abs;
  const double terms = 22.0 + 6.0 * abs(value_of(zeta * tau));  // what is left out is below 1e-18 of x
  Slide<T> slide{T(0.0), T(0.0), T(0.0), T(0.0)};
  T before(0.0);
  T term = tau * tau * tau / 6.0;  // a_n tau^n
  for (int n = 3; n < terms; ++n) {
    slide.x += term;
    slide.v += static_cast<double>(n) * term;
    slide.a += static_cast<double>(n * (n - 1)) * term;
    slide.integral += term / static_cast<double>(n + 1);
    const T next =
        (g * tau * tau * before / static_cast<double>(n) - 2.0 * zeta * tau * term) / static_cast<double>(n + 1);
    before = term;
    term = next;
  }
  if (tau > 0.0) {
    slide.v /= tau;
    slide.a /= tau * tau;
  }
  slide.integral *= tau;
  return slide;
}

/// The same at any tau.
template <class T>
Slide<T> slide_at(const T& g, const T& zeta, const T& tau) {
  using std::abs, std::cos, std::exp, std::sin, std::sqrt;
  if (abs(g) * tau * tau <= 1.0 && abs(zeta) * tau <= 5.0) return slide_by_series(g, zeta, tau);
  const T square = zeta * zeta + g;
  T c, s;  // exp(-zeta tau) cosh(beta tau) and exp(-zeta tau) sinh(beta tau) / beta, beta^2 = zeta^2 + g
  constexpr double kNearlyZero = 1e-4;
  if (abs(square) * tau * tau < kNearlyZero) {
    const T angle = square * tau * tau;
    const T decay = exp(-zeta * tau);
    c = decay * (1.0 + angle * (0.5 + angle / 24.0));
    s = decay * tau * (1.0 + angle * (1.0 / 6.0 + angle / 120.0));
  } else if (square > 0.0) {
    const T beta = sqrt(square);
    const T fast = 0.5 * exp((beta - zeta) * tau);
    const T slow = 0.5 * exp(-(beta + zeta) * tau);
    c = fast + slow;
    s = (fast - slow) / beta;
  } else {
    const T b = sqrt(-square);
    const T decay = exp(-zeta * tau);
    c = decay * cos(b * tau);
    s = decay * sin(b * tau) / b;
  }
  const T v = (c + zeta * s - 1.0) / g;
  const T x = (s + 2.0 * zeta * v - tau) / g;
  return {x, v, s, (v + 2.0 * zeta * x - 0.5 * tau * tau) / g};
}

/// The root of a function that changes its sign between `low` and `high`, to rounding.
template <class F>
double root_between(const F& f, double low, double high) {
  const double at_low = f(low);
  const double at_high = f(high);
  if (at_low == 0.0) return low;
  if (!(at_low * at_high < 0.0)) return high;
  std::uintmax_t evaluations = 60;
  const auto bracket = boost::math::tools::toms748_solve(f, low, high, at_low, at_high,
                                                         boost::math::tools::eps_tolerance<double>(52), evaluations);
  return 0.5 * (bracket.first + bracket.second);
}

/// When the speed comes back to 0 while the friction still falls: twice the mean of a swing, less where the swing
/// grows.
double time_to_stop(double g, double zeta) {
  if (!(zeta <= 0.0 && zeta * zeta + g < 0.0)) return std::numeric_limits<double>::infinity();
  const double turn = 2.0 * std::numbers::pi / std::sqrt(-zeta * zeta - g);
  constexpr double kBeyondAll = 100.0;  // a swing that grows to e^50 is longer than any D_c
  if (-zeta * turn > kBeyondAll) return std::numeric_limits<double>::infinity();
  return root_between([&](double tau) { return slide_at(g, zeta, tau).v; }, 0.5 * turn, turn);
}

}  // namespace

WeakeningSlip::WeakeningSlip(double z0, double zeta, double distance, ForceView view)
    : z0_(z0, 0),
      zeta_(zeta, 1),
      distance_(distance, 2),
      stiffening_((z0_ + 2.0 * zeta_) / distance_ - 1.0),
      view_(view) {
  const double tau = time_to_weaken();
  if (std::isfinite(tau)) {
    const Slide<double> slide = slide_at(stiffening_.a, zeta, tau);
    // x(tau; z0, zeta, distance) = distance
    const Slide<Jet> moved = slide_at(stiffening_, zeta_, Jet(tau));
    weakened_ = weakening_at(Jet(tau) - (moved.x - distance_) / slide.v);
    end_when_weakened();
  } else {
    end_while_weakening();
  }
}

/// Infinite where the slip sticks before.
double WeakeningSlip::time_to_weaken() const {
  const double g = stiffening_.a;
  const double zeta = zeta_.a;
  const double longest = time_to_stop(g, zeta);
  double high = std::min(longest, std::cbrt(6.0 * distance_.a));  // x = tau^3 / 6 to begin with
  while (slide_at(g, zeta, high).x < distance_.a) {
    if (high >= longest) return std::numeric_limits<double>::infinity();
    high = std::min(longest, 2.0 * high);
  }
  return root_between([&](double tau) { return slide_at(g, zeta, tau).x - distance_.a; }, 0.0, high);
}

WeakeningSlip::State WeakeningSlip::weakening_at(const Jet& tau) const {
  const Slide<Jet> slide = slide_at(stiffening_, zeta_, tau);
  return {tau, z0_ + tau - slide.x, 1.0 - slide.v, -slide.a, tau * (z0_ + 0.5 * tau) - slide.integral};
}

/// z'' + 2 zeta z' + z = 0 from where the friction has become F_k; its integral is that of (1).
WeakeningSlip::State WeakeningSlip::weakened_at(const Jet& tau) const {
  const Jet since = tau - weakened_.tau;
  const Jet b = sqrt(1.0 - zeta_ * zeta_);
  const Jet c = exp(-zeta_ * since) * cos(b * since);
  const Jet s = exp(-zeta_ * since) * sin(b * since) / b;
  const Jet z = weakened_.z * c + (weakened_.dz + zeta_ * weakened_.z) * s;
  const Jet dz = weakened_.dz * c - (weakened_.z + zeta_ * weakened_.dz) * s;
  const Jet integral = weakened_.integral + weakened_.dz - dz + 2.0 * zeta_ * (weakened_.z - z);
  return {tau, z, dz, -2.0 * zeta_ * dz - z, integral};
}

/// z' meets 1 between the largest sliding speed, or the end of weakening where that comes later, and the smallest one:
/// there z'' = 0.
void WeakeningSlip::end_when_weakened() {
  const double zeta = zeta_.a;
  const double b = std::sqrt(1.0 - zeta * zeta);
  const SlipPoint<double> begin{weakened_.z.a, weakened_.dz.a, -2.0 * zeta * weakened_.dz.a - weakened_.z.a};
  // z'' = exp(-zeta tau) (p cos b tau + q sin b tau) is a sine of phase atan2(p, q).
  const double phase = std::atan2(begin.ddz, (-zeta * begin.ddz - begin.dz) / b);
  const double fastest = std::max(0.0, -phase / b);
  const double slowest = (std::numbers::pi - phase) / b;
  const auto speed_below = [&](double since) {
    const double decay = std::exp(-zeta * since);
    return decay * (begin.dz * std::cos(b * since) - (begin.z + zeta * begin.dz) / b * std::sin(b * since)) - 1.0;
  };
  resticks_ = speed_below(slowest) >= 0.0;
  const double since = resticks_ ? root_between(speed_below, fastest, slowest) : slowest;
  tau_end_ = weakened_.tau.a + since;
  end_ = weakened_at(Jet(tau_end_));
  if (resticks_) return;
  const Jet dddz = -2.0 * zeta_ * end_.ddz - end_.dz;
  end_ = weakened_at(Jet(tau_end_) - end_.ddz / dddz);
}

/// Only where zeta <= 0: otherwise the speed does not come back to 0.
void WeakeningSlip::end_while_weakening() {
  tau_end_ = time_to_stop(stiffening_.a, zeta_.a);
  weakened_.tau = Jet(std::numeric_limits<double>::infinity());
  weakened_.dz = Jet(1.0);
  end_ = weakening_at(Jet(tau_end_));
}

WeakeningSlip::State WeakeningSlip::state_at(double tau) const {
  const Jet now(tau);
  if (tau <= 0.0) return {now, z0_ + tau, Jet(1.0), Jet(0.0), tau * (z0_ + 0.5 * tau)};
  if (tau <= tau_end_) return tau <= weakened_.tau.a ? weakening_at(now) : weakened_at(now);
  // A slip that sticks again joins its ramp with equal slope: the moving end adds nothing to first order.
  const Jet since = tau - end_.tau;
  return {now, end_.z + since, Jet(1.0), Jet(0.0), end_.integral + since * (end_.z + 0.5 * since)};
}

/// In the view: z, its derivative and its integral.
WeakeningSlip::State WeakeningSlip::shown_at(double tau) const {
  State state = state_at(tau);
  if (view_ != ForceView::Transmitted) return state;
  state.integral += 2.0 * zeta_ * state.z;
  state.z += 2.0 * zeta_ * state.dz;
  state.dz += 2.0 * zeta_ * state.ddz;
  return state;
}

WeakeningPoint WeakeningSlip::at(double tau) const {
  const State now = shown_at(tau);
  return {{now.z.a, now.z.v[0], now.z.v[1], now.dz.a}, now.z.v[2]};
}

WeakeningPoint WeakeningSlip::mean_at(double tau, double average) const {
  const State first = shown_at(tau - 0.5 * average);
  const State last = shown_at(tau + 0.5 * average);
  const Jet mean = (last.integral - first.integral) / average;
  const double by_tau = (last.z.a - first.z.a) / average;
  const double by_log_average = 0.5 * (first.z.a + last.z.a) - mean.a;
  return {{mean.a, mean.v[0], mean.v[1], by_tau, by_log_average}, mean.v[2]};
}

}  // namespace slipfit::model
