#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "slipfit/model/motion.hpp"

namespace slipfit {

/// The parameters with respect to which the Coulomb tiers are differentiated, in this order, each in its SI unit.
enum ModelParameter : std::size_t {
  kStiffness,
  kNaturalFrequency,
  kDampingRatio,
  kStaticFriction,
  kKineticFriction,
  kDrivingSpeed,
  kSensitivityParameters
};

/// A value and its derivatives.
struct Sensitive {
  double value = 0.0;
  std::array<double, kSensitivityParameters> gradient{};
};

/// One period with exact derivatives: the end of slip moves with the parameters (implicit function theorem).
struct CycleSensitivity {
  Sensitive slip_s;
  Sensitive stick_s;
  Sensitive period_s;
  Sensitive periodic_displacement_m;
  Sensitive force_peak_N;
  Sensitive force_trough_N;
  Sensitive onset_force_N;
  Sensitive end_force_N;
};

/// Returns the cycle with its derivatives; empty if `damped_motion` has no cycle. speed > 0.
std::optional<CycleSensitivity> damped_sensitivity(const Slider& slider, const Friction& friction,
                                                   double speed_m_per_s);

}  // namespace slipfit
