#pragma once

// A body with velocity-dependent friction at one driving speed, in the units of velocity_law.hpp.

#include <cmath>

#include "model/parameter_error.hpp"
#include "model/velocity_law.hpp"
#include "slipfit/model/motion.hpp"
#include "slipfit/model/velocity_friction.hpp"

namespace slipfit::model {

/// Force of k V / w_n, and the slip in these units.
struct SpeedUnits {
  double force_N = 0.0;
  ScaledSlip slip;
};

inline Result<SpeedUnits> in_speed_units(const Slider& slider, const VelocityFriction& friction, double speed_m_per_s) {
  if (!is_positive(speed_m_per_s)) return out_of_range("speed (m/s)", speed_m_per_s, "a number > 0");
  const double force_N = slider.stiffness_N_per_m() * speed_m_per_s / slider.natural_frequency_rad_per_s();
  if (!is_positive(force_N)) return out_of_range("k V / w_n (N)", force_N, "a number > 0");
  const double lambda = (friction.static_N() - friction.onset_N()) / force_N;
  const double rate = friction.alpha_s_per_m() * speed_m_per_s;
  const ScaledLaw law{friction.f1_N() / force_N * rate, rate};
  if (!std::isfinite(lambda)) return out_of_range("lambda", lambda, "a finite number");
  if (!std::isfinite(law.slope)) return out_of_range("f1 alpha w_n / k", law.slope, "a finite number");
  if (!(std::isfinite(law.rate) && std::isfinite(law.at(1.0).d_speed))) {
    return out_of_range("alpha * speed", law.rate, "a number whose exponential is finite");
  }
  return SpeedUnits{force_N, {lambda, slider.damping_ratio(), law}};
}

/// `sticks`: from stick, at the first return.
inline Regime regime_of(double total_damping_ratio, bool sticks) {
  if (sticks) return total_damping_ratio > 0.0 ? Regime::StickSlipBistable : Regime::StickSlip;
  if (total_damping_ratio < 0.0) return Regime::UnstableSteady;  // by round-off at best: docs/model.md (17)
  return total_damping_ratio < 1.0 ? Regime::OscillatorySlip : Regime::ContinuousSlip;
}

inline Error no_convergence(const ScaledSlip& slip) {
  const auto text = [](double value) { return short_text(value); };
  return {"no_convergence", "the slip with lambda " + text(slip.lambda) + ", damping ratio " + text(slip.zeta) +
                                ", f1 alpha w_n / k " + text(slip.law.slope) + ", alpha V " + text(slip.law.rate) +
                                " runs away or is too stiff to be followed, expected friction that changes less"};
}

}  // namespace slipfit::model
