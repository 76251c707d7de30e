#pragma once

#include <optional>

#include "slipfit/core/result.hpp"

namespace slipfit {

/// The sliding body on its spring: m x'' + c x' + k x (docs/model.md section 1). Mass is k / w_n^2.
class Slider {
 public:
  /// Creates a slider: stiffness > 0, natural frequency > 0, damping ratio >= 0, all finite. Errors name parameter,
  /// value and range.
  static Result<Slider> create(double stiffness_N_per_m, double natural_frequency_rad_per_s, double damping_ratio);

  [[nodiscard]] double stiffness_N_per_m() const { return stiffness_N_per_m_; }
  [[nodiscard]] double natural_frequency_rad_per_s() const { return natural_frequency_rad_per_s_; }
  [[nodiscard]] double damping_ratio() const { return damping_ratio_; }
  [[nodiscard]] double mass_kg() const {
    return stiffness_N_per_m_ / (natural_frequency_rad_per_s_ * natural_frequency_rad_per_s_);
  }
  /// Returns c = 2 zeta k / w_n, [Paper] eq. (6).
  [[nodiscard]] double damping_N_s_per_m() const {
    return 2.0 * damping_ratio_ * stiffness_N_per_m_ / natural_frequency_rad_per_s_;
  }

 private:
  double stiffness_N_per_m_ = 0.0;
  double natural_frequency_rad_per_s_ = 0.0;
  double damping_ratio_ = 0.0;
};

/// Coulomb friction with a static peak: 0 <= kinetic <= static, finite.
class Friction {
 public:
  static Result<Friction> create(double static_N, double kinetic_N);

  [[nodiscard]] double static_N() const { return static_N_; }
  [[nodiscard]] double kinetic_N() const { return kinetic_N_; }
  [[nodiscard]] double difference_N() const { return static_N_ - kinetic_N_; }

 private:
  double static_N_ = 0.0;
  double kinetic_N_ = 0.0;
};

/// The regime of the motion. Bistable: stick-slip from rest, while steady sliding is stable as well.
enum class Regime { StickSlip, StickSlipBistable, OscillatorySlip, ContinuousSlip, UnstableSteady };

/// One period of the stick-slip motion.
struct LimitCycle {
  double slip_s = 0.0;
  double stick_s = 0.0;
  double period_s = 0.0;
  double sticking_degree = 0.0;          ///< stick_s / period_s
  double periodic_displacement_m = 0.0;  ///< V * period_s
  double force_peak_N = 0.0;             ///< largest spring force; above F_s - cV, see docs/model.md
  double force_trough_N = 0.0;           ///< smallest spring force
  double onset_force_N = 0.0;            ///< spring force at the start of slip, F_s - cV
  double end_force_N = 0.0;              ///< spring force at the end of slip
  double mean_force_N = 0.0;             ///< spring force over a period; F_k at zeta = 0
};

/// The motion at one speed; no cycle means no stick-slip at this speed, which is an answer and not an error.
struct Motion {
  Regime regime = Regime::ContinuousSlip;
  double lambda = 0.0;  ///< w_n (F_s - F_k) / (k V), [Paper] eq. (9)
  std::optional<LimitCycle> cycle;
};

/// Returns the exact solution of the Coulomb tier with viscous damping (docs/model.md section 4; zeta = 0 is section 2,
/// [Paper] eqs (12)-(27)). The relative accuracy is 4e-14 for lambda from 1e-6 to 1e8. speed > 0. At zeta >= 1 there is
/// no cycle but continuous slip.
Motion damped_motion(const Slider& slider, const Friction& friction, double speed_m_per_s);

/// Returns the smallest lambda at which a slip that starts from stick sticks again; 0 for zeta = 0. zeta is in [0, 1).
double critical_lambda(double damping_ratio);

/// Returns the speed above which stick-slip ends, V_c = w_n (F_s - F_k) / (k lambda_c); empty if it never ends (zeta =
/// 0), and 0 if there is none at any speed (zeta >= 1).
std::optional<double> critical_speed_m_per_s(const Slider& slider, const Friction& friction);

}  // namespace slipfit
