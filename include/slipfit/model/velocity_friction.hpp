#pragma once

#include "slipfit/core/result.hpp"

namespace slipfit {

/// Kinetic friction that depends on the sliding speed v: F_k(v) = f0 + f1 exp(alpha v), [Paper] eq. (41) with the
/// normal force multiplied in (docs/model.md section 5). The law is used unchanged: with f0 < 0 or f1 < 0 it may
/// fall below zero at high speed.
class VelocityFriction {
 public:
  /// Creates the friction law: all parameters finite, f0 + f1 >= 0, static >= f0 + f1; alpha of either sign. Errors
  /// name parameter, value and range.
  static Result<VelocityFriction> create(double static_N, double f0_N, double f1_N, double alpha_s_per_m);

  [[nodiscard]] double static_N() const { return static_N_; }
  [[nodiscard]] double f0_N() const { return f0_N_; }
  [[nodiscard]] double f1_N() const { return f1_N_; }
  [[nodiscard]] double alpha_s_per_m() const { return alpha_s_per_m_; }
  /// Returns F_k(0+), the kinetic friction in lambda.
  [[nodiscard]] double onset_N() const { return f0_N_ + f1_N_; }
  /// Returns F_k at a sliding speed >= 0; infinite if the exponential overflows.
  [[nodiscard]] double kinetic_N(double speed_m_per_s) const;

 private:
  double static_N_ = 0.0;
  double f0_N_ = 0.0;
  double f1_N_ = 0.0;
  double alpha_s_per_m_ = 0.0;
};

}  // namespace slipfit
