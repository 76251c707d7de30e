#pragma once

// Velocity-dependent friction in scaled form (docs/model.md section 5): forces in k V / w_n, speeds in V, times in
// 1/w_n.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace slipfit::model {

/// g(v) = F_k(v) - F_k(0+) and its derivatives with respect to the speed and to the law's two parameters.
struct ExcessFriction {
  double value = 0.0, d_speed = 0.0, d_slope = 0.0, d_rate = 0.0;
};

/// How g bends: g' = slope (1 - rate v / q)^-q with q infinite, 2 or 1. All three begin with slope and curvature alike.
enum class LawShape {
  Exponential,  ///< g = slope (exp(rate v) - 1) / rate
  Hyperbolic,   ///< g = slope v / (1 - rate v / 2); rate < 0
  Logarithmic   ///< g = -slope ln(1 - rate v) / rate; rate < 0
};

/// slope = f1 alpha w_n / k, rate = alpha V; at rate 0 linear in the speed.
struct ScaledLaw {
  double slope = 0.0;
  double rate = 0.0;
  LawShape shape = LawShape::Exponential;

  [[nodiscard]] ExcessFriction at(double v) const {
    if (shape != LawShape::Exponential) return algebraic_at(v);
    // Overflow stays infinite: the error control rejects a step that meets it, but would accept a large constant.
    const double x = rate * v;
    const double growth = std::expm1(x);
    const double d_slope = rate == 0.0 ? v : growth * (1.0 / rate);  // the division does not wait for the exponential
    if (slope == 0.0) return {0.0, 0.0, d_slope, 0.0};               // not 0 * infinity
    // The difference below loses its digits where x is small; the series leaves out x^4 / 144.
    const double d_rate = std::abs(x) < 1e-3 ? v * v * (0.5 + x * (1.0 / 3.0 + x * (0.125 + x / 30.0)))
                                             : (v * (growth + 1.0) - d_slope) / rate;
    return {slope * d_slope, slope * (growth + 1.0), d_slope, slope * d_rate};
  }

  /// The smallest slope of the friction above the driving speed (v > 1): it alone can pull a fast slip below v = 1.
  [[nodiscard]] double smallest_slope_of_fast_slip() const {
    const double here = at(1.0).d_speed;
    if (rate <= 0.0) return std::min(here, 0.0);  // the slope dies out: it lies between here and 0
    return slope >= 0.0 ? here : -std::numeric_limits<double>::infinity();
  }

 private:
  [[nodiscard]] ExcessFriction algebraic_at(double v) const {
    const bool is_hyperbolic = shape == LawShape::Hyperbolic;
    const double x = rate * v;
    const double left = 1.0 - (is_hyperbolic ? 0.5 * x : x);
    if (!(left > 0.0)) return {std::numeric_limits<double>::infinity(), 0.0, 0.0, 0.0};  // rejected as an overflow is
    if (is_hyperbolic) {
      const double d_slope = v / left;
      return {slope * d_slope, slope / (left * left), d_slope, 0.5 * slope * d_slope * d_slope};
    }
    const double logarithm = std::log1p(-x);
    const double d_slope = rate == 0.0 ? v : -logarithm / rate;
    // The difference loses its digits where x is small; the series leaves out x^3.
    const double d_rate = std::abs(x) < 1e-4 ? v * v * (0.5 + x * (2.0 / 3.0 + 0.75 * x)) : (v / left - d_slope) / rate;
    return {slope * d_slope, slope / left, d_slope, slope * d_rate};
  }
};

/// One slip in scaled form:
///   s' = 1 - v,  v' = s - 2 zeta v - g(v),  s(0) = lambda, v(0) = 0,  s = (k u - F_k(0+)) w_n / (k V) + 2 zeta.
/// s and v, not u and u', so that small and large lambda, alpha -> 0 and v -> 0 keep their relative precision.
struct ScaledSlip {
  double lambda = 0.0;
  double zeta = 0.0;
  ScaledLaw law;

  /// (c + c_v) / (2 sqrt(k m)) with the tangent c_v of the friction at the driving speed.
  [[nodiscard]] double total_damping_ratio() const { return zeta + 0.5 * law.at(1.0).d_speed; }
  /// s of steady sliding, v = 1.
  [[nodiscard]] double steady_s() const { return 2.0 * zeta + law.at(1.0).value; }
};

}  // namespace slipfit::model
