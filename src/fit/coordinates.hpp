#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "slipfit/fit/parameter.hpp"

namespace slipfit::fit {

/// What a fit solves for, dimensionless, in the order of every vector and matrix of it. The first ones are common to
/// all cycles and recordings while fitting; the others are means over the cycles, or lines through the recordings' own
/// values. With F_k(v) = F_k(0+) + b (exp(alpha v) - 1) / alpha (docs/model.md section 5; b = f1 alpha is its slope at
/// v = 0, finite where alpha -> 0 and f1 has no limit) and v_c = Units::slip_speed_m_per_s:
enum Coordinate : Eigen::Index {
  kLogStiffness,  ///< ln k
  kLogFrequency,  ///< ln w_n
  kDamping,       ///< zeta; may be negative while fitting (any |zeta| < 1), so that its estimate is not pushed from 0
  /// (F_k(v_c) - F_k(0+)) / (2 v_c sqrt(k m)), the mean share of friction in the damping of a slip: the data fix it
  /// whatever alpha is, which the slope at v = 0 is not.
  kFrictionSlope,
  kFrictionRate,  ///< a = alpha v_c
  kGlobals,
  kLevel = kGlobals,   ///< F_k(0+) / Units::force, from Units::level
  kDifference,         ///< (F_s - F_k(0+)) / Units::force
  kAgeing,             ///< rate of ageing / Units::force
  kAgeingTime,         ///< cut-off of ageing / Units::stick_s
  kSlipDistance,       ///< sqrt(D_c / Units::slip_distance_m): the limit of Coulomb friction is reached as it goes to 0
  kReloadForce,        ///< A / Units::force, of the rise after a slip
  kReloadLength,       ///< ln (l / m), of the path over which it rises
  kStiffnessExponent,  ///< d ln k / d ln V, of a sweep; k and w_n are those at Units::speed_m_per_s
  kSensorTime,         ///< (time / Scales::sensor_time_unit_s)^2, of the time of the sensor that is free
  kCoordinates
};

/// In the order of Coordinate; under friction that weakens the first behind zeta is kSlipDistance.
using Globals = std::array<double, kGlobals>;
/// Which of the globals stand still.
using Held = std::array<bool, kGlobals>;
using Coordinates = Eigen::Matrix<double, kCoordinates, 1>;
using CoordinateMatrix = Eigen::Matrix<double, kCoordinates, kCoordinates>;

/// The globals that the user holds.
inline Held held_of(const HeldParameters& parameters) {
  Held held{};
  held[kLogStiffness] = parameters.stiffness_N_per_m.has_value();
  held[kLogFrequency] = parameters.natural_frequency_rad_per_s.has_value();
  held[kDamping] = parameters.damping_ratio.has_value();
  return held;
}

/// Bounds of kFrictionRate: friction that changes within a tenth of the speeds of a slip, or grows by more than exp(2)
/// over them, is another law.
inline constexpr double kLeastRate = -10.0;
inline constexpr double kMostRate = 2.0;

enum class FrictionLaw {
  Coulomb,      ///< F_k is constant: the slip in closed form
  Exponential,  ///< F_k(v), the slip integrated; the same of the others
  Hyperbolic,
  Logarithmic,
  Weakening  ///< over a slip distance: in closed form
};

/// Coulomb friction has no slope and no rate, friction that weakens a slip distance in their place.
constexpr std::size_t globals_of(FrictionLaw law) {
  if (law == FrictionLaw::Weakening) return kFrictionSlope + 1;
  return law == FrictionLaw::Coulomb ? kFrictionSlope : kGlobals;
}

/// What a global stands for.
constexpr Coordinate coordinate_of(FrictionLaw law, std::size_t global) {
  const bool is_distance = law == FrictionLaw::Weakening && global == kFrictionSlope;
  return is_distance ? kSlipDistance : static_cast<Coordinate>(global);
}

/// What the coordinates count in.
struct Units {
  double force = 1.0;
  double level = 0.0;               ///< force at which the level counts 0
  double slip_speed_m_per_s = 1.0;  ///< typical fastest sliding, (F_s - F_k) w_n / k
  double stick_s = 1.0;             ///< typical stick time: static friction that ages is stated for it
  double slip_distance_m = 1.0;     ///< typical half drop over k
  double speed_m_per_s = 1.0;       ///< mean of ln V of a sweep's recordings with cycles
};

}  // namespace slipfit::fit
