#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "slipfit/core/estimate.hpp"
#include "slipfit/core/range.hpp"

namespace slipfit {

/// The parameters of a fit, in the order of every report.
enum class ParameterId : std::size_t {
  Stiffness,
  StiffnessExponent,
  StiffnessRatio,
  FrictionDifference,
  FrictionCoefficientDifference,
  Ageing,
  AgeingTime,
  StaticFriction,
  StaticFrictionCoefficient,
  KineticFriction,
  KineticFrictionCoefficient,
  NaturalFrequency,
  Mass,
  DampingRatio,
  DampingCoefficient,
  FrictionSlope,
  Alpha,
  F0,
  F1,
  Mu0,
  Mu1,
  SensorAverage,
  SlipDistance,
  ReloadForce,
  ReloadLength,
  Relaxation,
  RelaxationTime
};

struct ParameterInfo {
  ParameterId id{};
  std::string_view key;    ///< in JSON and CSV, unit included
  std::string_view words;  ///< for people
  std::string_view unit;   ///< SI; empty for a pure number
  Range range;
  /// The largest relative standard error of an identified parameter (a quarter of the 95 % interval is compared with
  /// it).
  double identified_below = 0.0;
  bool can_be_held = false;             ///< by HeldParameters
  bool depends_on_sensor_zero = false;  ///< a force level: off by what the sensor's zero is off
};

/// Returns the table of all parameters.
std::span<const ParameterInfo> parameter_table();
const ParameterInfo& info(ParameterId id);
/// Returns the parameter with this key, or nothing if the key is unknown.
std::optional<ParameterId> parameter_with_key(std::string_view key);

/// One parameter of a fit in SI units.
struct Parameter {
  ParameterId id{};
  Estimate estimate;
  ParameterStatus status = ParameterStatus::Unidentified;

  [[nodiscard]] std::string_view name() const { return info(id).key; }
};

/// Parameters that the user states, in SI; stiffness and frequency > 0, 0 <= damping ratio < 1.
struct HeldParameters {
  std::optional<double> stiffness_N_per_m{};
  std::optional<double> natural_frequency_rad_per_s{};
  std::optional<double> damping_ratio{};
};

/// The parameters of a model's covariance, in its order.
inline constexpr std::array kModelParameters{ParameterId::Stiffness,
                                             ParameterId::NaturalFrequency,
                                             ParameterId::DampingRatio,
                                             ParameterId::FrictionDifference,
                                             ParameterId::FrictionSlope,
                                             ParameterId::Alpha,
                                             ParameterId::Ageing,
                                             ParameterId::AgeingTime,
                                             ParameterId::ReloadForce,
                                             ParameterId::ReloadLength,
                                             ParameterId::StiffnessExponent,
                                             ParameterId::Relaxation,
                                             ParameterId::RelaxationTime};
inline constexpr std::size_t kModelValues = kModelParameters.size();

/// Returns the position of a parameter in the covariance of the model.
constexpr std::size_t place_in_model(ParameterId id) {
  std::size_t place = 0;
  while (place < kModelValues && kModelParameters[place] != id) ++place;
  return place;
}

/// Returns whether the covariance of a model is that of the parameter's logarithm.
constexpr bool enters_as_logarithm(ParameterId id) {
  return id == ParameterId::Stiffness || id == ParameterId::NaturalFrequency || id == ParameterId::FrictionDifference ||
         id == ParameterId::ReloadLength || id == ParameterId::RelaxationTime;
}

}  // namespace slipfit
