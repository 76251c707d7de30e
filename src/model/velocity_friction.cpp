#include "slipfit/model/velocity_friction.hpp"

#include <cmath>

#include "model/parameter_error.hpp"

namespace slipfit {

using model::out_of_range;

Result<VelocityFriction> VelocityFriction::create(double static_N, double f0_N, double f1_N, double alpha_s_per_m) {
  if (!std::isfinite(f0_N)) return out_of_range("f0 (N)", f0_N, "a finite number");
  if (!std::isfinite(f1_N)) return out_of_range("f1 (N)", f1_N, "a finite number");
  if (!std::isfinite(alpha_s_per_m)) return out_of_range("alpha (s/m)", alpha_s_per_m, "a finite number");
  const double onset_N = f0_N + f1_N;
  if (!(std::isfinite(onset_N) && onset_N >= 0.0)) return out_of_range("f0 + f1 (N)", onset_N, "a number >= 0");
  if (!(std::isfinite(static_N) && static_N >= onset_N)) {
    return out_of_range("static friction (N)", static_N, "a number not below f0 + f1");
  }
  VelocityFriction friction;
  friction.static_N_ = static_N;
  friction.f0_N_ = f0_N;
  friction.f1_N_ = f1_N;
  friction.alpha_s_per_m_ = alpha_s_per_m;
  return friction;
}

double VelocityFriction::kinetic_N(double speed_m_per_s) const {
  // From F_k(0+), not f0: exact at rest, and 0 * exp(overflow) does not turn into NaN at f1 = 0.
  return f1_N_ == 0.0 ? f0_N_ : onset_N() + f1_N_ * std::expm1(alpha_s_per_m_ * speed_m_per_s);
}

}  // namespace slipfit
