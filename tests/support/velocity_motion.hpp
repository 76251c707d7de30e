#pragma once

// The exact motion under friction that depends on the speed, which fits and predictions (model/velocity_slip.hpp, to
// 1e-7) and simulations are held against.

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "slipfit/core/result.hpp"
#include "slipfit/model/motion.hpp"
#include "slipfit/model/velocity_friction.hpp"

namespace slipfit {

/// Motion with velocity-dependent friction. `motion.regime` says StickSlip where steady sliding is unstable, and
/// StickSlipBistable where it is stable too. A slip from stick that does not stick at its first return never does, and
/// where steady sliding is unstable it always sticks: docs/model.md (16), (17).
struct VelocityMotion {
  Motion motion;                     ///< lambda with F_k(0+)
  double total_damping_ratio = 0.0;  ///< zeta + slope of F_k at V / (2 sqrt(k m)): < 0 where steady sliding is unstable
  /// Speed at which steady sliding changes stability, ln(-c / (alpha f1)) / alpha; empty where it never does.
  std::optional<double> stability_speed_m_per_s;
};

/// The limit cycle that is reached from rest. Times and forces hold to 1e-10 relative for lambda from 0.02 to 1e8;
/// below, where the slip only just sticks, to 1e-13 / lambda^2. Whether it sticks again is decided to 1e-11 of V in the
/// smallest sliding speed. Errors: parameter_out_of_range (speed <= 0 or not finite; lambda or alpha * speed that
/// overflows), no_convergence (the slip runs away, or is so stiff that the bounded work does not reach its end).
Result<VelocityMotion> velocity_motion(const Slider& slider, const VelocityFriction& friction, double speed_m_per_s);

/// The parameters of a velocity-dependent slip, in the order of every gradient.
enum class VelocityParameter {
  Stiffness,         ///< N/m
  NaturalFrequency,  ///< rad/s
  DampingRatio,      ///< 1
  StaticFriction,    ///< N
  F0,                ///< N
  F1,                ///< N
  Alpha,             ///< s/m
  Speed              ///< m/s
};
inline constexpr std::size_t kVelocityParameters = 8;

/// A quantity of the limit cycle and its derivatives, each in (unit of the quantity) / (unit of the parameter).
struct VelocityDerivative {
  double value = 0.0;
  std::array<double, kVelocityParameters> gradient{};

  [[nodiscard]] double by(VelocityParameter parameter) const { return gradient[static_cast<std::size_t>(parameter)]; }
};

/// Exact across the end of slip (implicit function theorem). They grow without bound where the slip only just sticks.
struct VelocityDerivatives {
  VelocityDerivative slip_s, stick_s, period_s, periodic_displacement_m;
  VelocityDerivative onset_force_N, end_force_N, force_peak_N, force_trough_N;
};

/// Values and derivatives of the limit cycle; empty where the slip does not stick again. Good to 1e-9 of quantity /
/// parameter. Errors as velocity_motion.
Result<std::optional<VelocityDerivatives>> velocity_derivatives(const Slider& slider, const VelocityFriction& friction,
                                                                double speed_m_per_s);

/// Spring force and sliding speed at given times after the start of a slip.
struct VelocityWaveform {
  std::vector<double> spring_force_N;
  std::vector<double> sliding_speed_m_per_s;  ///< 0 in stick
  std::optional<double> slip_s;               ///< empty: it does not stick again before the last time asked for
};

/// One slip from F_s - cV and the stick after it (a straight ramp without end), by dense output: 1e-10 of the largest
/// force above F_k(0+). Times >= 0, finite, ascending. Errors as velocity_motion.
Result<VelocityWaveform> velocity_waveform(const Slider& slider, const VelocityFriction& friction, double speed_m_per_s,
                                           std::span<const double> slip_time_s);

}  // namespace slipfit
