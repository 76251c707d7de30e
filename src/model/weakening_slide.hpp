#pragma once

#include <ceres/jet.h>

#include <cmath>

namespace slipfit::model {

inline double value_of(double x) {
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

/// Returns the slide of the same equation at any tau.
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

}  // namespace slipfit::model
