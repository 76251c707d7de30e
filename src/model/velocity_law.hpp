#pragma once

// Velocity-dependent friction in scaled form (docs/model.md section 5): forces in k V / w_n, speeds in V, times in
// 1/w_n.

#include <algorithm>
#include <cmath>
#include <limits>

namespace slipfit::model {

/// g(v) = F_k(v) - F_k(0+) and its derivatives with respect to the speed and to the law's two parameters.
struct ExcessFriction {
  double value = 0.0, slope = 0.0, d_strength = 0.0, d_rate = 0.0;
};

/// g = strength (exp(rate v) - 1), strength = f1 w_n / (k V), rate = alpha V.
struct ScaledLaw {
  double strength = 0.0;
  double rate = 0.0;

  [[nodiscard]] ExcessFriction at(double v) const {
    // Overflow stays infinite: the error control rejects a step that meets it, but would believe in a large plateau.
    const double growth = std::expm1(rate * v);
    if (strength == 0.0) return {0.0, 0.0, growth, 0.0};  // not 0 * infinity
    const double slope = strength * (growth + 1.0);
    return {strength * growth, slope * rate, growth, slope * v};
  }

  /// The smallest slope of the friction above the driving speed (v > 1): it alone can pull a fast slip below v = 1.
  [[nodiscard]] double smallest_slope_of_fast_slip() const {
    const double here = at(1.0).slope;
    if (rate <= 0.0) return std::min(here, 0.0);  // the slope dies out: it lies between here and 0
    return strength >= 0.0 ? here : -std::numeric_limits<double>::infinity();
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
  [[nodiscard]] double total_damping_ratio() const { return zeta + 0.5 * law.at(1.0).slope; }
  /// s of steady sliding, v = 1.
  [[nodiscard]] double steady_s() const { return 2.0 * zeta + law.at(1.0).value; }
};

}  // namespace slipfit::model
