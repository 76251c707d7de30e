#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "slipfit/fit/parameter.hpp"

namespace slipfit::fit {

/// The parameters of a fit, dimensionless, in the order of every vector and matrix of it. A fit solves for those that
/// its law, its sensor and its recordings have (Columns); the others are means over the cycles, or lines
/// through the recordings' own values. With F_k(v) = F_k(0+) + b (exp(alpha v) - 1) / alpha (docs/model.md section 5;
/// b = f1 alpha is its slope at v = 0, finite where alpha -> 0 and f1 has no limit) and v_c =
/// Units::slip_speed_m_per_s:
enum Coordinate : Eigen::Index {
  kLogStiffness,  ///< ln k
  kLogFrequency,  ///< ln w_n
  kDamping,       ///< zeta; may be negative while fitting (any |zeta| < 1), so that its estimate is not pushed from 0
  /// (F_k(v_c) - F_k(0+)) / (2 v_c sqrt(k m)), the mean share of friction in the damping of a slip: the data fix it
  /// whatever alpha is, which the slope at v = 0 is not.
  kFrictionSlope,
  kFrictionRate,       ///< a = alpha v_c
  kSlipDistance,       ///< sqrt(D_c / Units::slip_distance_m): the limit of Coulomb friction is reached as it goes to 0
  kRelaxation,         ///< s, the share of k that relaxes
  kRelaxationTime,     ///< ln (t_r / s), of the time in which it relaxes
  kReloadForce,        ///< A / Units::force, of the rise after a slip
  kReloadLength,       ///< ln (l / m), of the path over which it rises
  kStiffnessExponent,  ///< d ln k / d ln V, of a sweep; k and w_n are those at Units::speed_m_per_s
  /// Half of the change of ln k from the first to the last cycle: k and w_n are those in the middle of the path.
  kStiffnessDrift,
  kSensorTime,  ///< (time / Scales::sensor_time_unit_s)^2, of the time of the sensor that is free
  kLevel,       ///< F_k(0+) / Units::force, from Units::level
  kDifference,  ///< (F_s - F_k(0+)) / Units::force
  kAgeing,      ///< rate of ageing / Units::force
  kAgeingTime,  ///< cut-off of ageing / Units::stick_s
  kCoordinates
};

using Coordinates = Eigen::Matrix<double, kCoordinates, 1>;
using CoordinateMatrix = Eigen::Matrix<double, kCoordinates, kCoordinates>;
/// Returns whether each recording of a sweep has its own value. F_s - F_k(0+) may be shared, A is proportional to the
/// load, and k changes along the path of each recording. All other coordinates belong to the contact and the rig.
constexpr bool is_of_recording(Coordinate coordinate) {
  return coordinate == kDifference || coordinate == kReloadForce || coordinate == kStiffnessDrift;
}

/// Those of the rig and of friction in the slip come first.
inline constexpr int kOfSlip = kSlipDistance + 1;
/// States which of the coordinates are fixed while fitting.
using Held = std::array<bool, kCoordinates>;

/// k in N/m, w_n in rad/s and zeta by their logarithms and itself; all other coordinates are 0.
inline Coordinates oscillator(double log_stiffness, double log_frequency, double zeta) {
  Coordinates values = Coordinates::Zero();
  values.head<3>() << log_stiffness, log_frequency, zeta;
  return values;
}

/// The coordinates that the user holds.
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

/// The slip of such a law is integrated.
constexpr bool depends_on_speed(FrictionLaw law) {
  return law == FrictionLaw::Exponential || law == FrictionLaw::Hyperbolic || law == FrictionLaw::Logarithmic;
}

/// Holds the units of the coordinates.
struct Units {
  double force = 1.0;
  double level = 0.0;               ///< force at which the level counts 0
  double slip_speed_m_per_s = 1.0;  ///< typical fastest sliding, (F_s - F_k) w_n / k
  double stick_s = 1.0;             ///< typical stick time: static friction that ages is stated for it
  double slip_distance_m = 1.0;     ///< typical half drop over k
  double speed_m_per_s = 1.0;       ///< mean of ln V of a sweep's recordings with cycles
};

}  // namespace slipfit::fit
