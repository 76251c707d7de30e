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
  ReloadLength
};

struct ParameterInfo {
  ParameterId id{};
  std::string_view key;    ///< in JSON and CSV, unit included
  std::string_view words;  ///< for people
  std::string_view unit;   ///< SI; empty for a pure number
  Range range;
  /// Identified needs a standard error below this share of the value (by a quarter of the 95 % interval).
  double identified_below = 0.0;
  bool can_be_held = false;    ///< by HeldParameters
  bool hangs_on_zero = false;  ///< a force level: off by what the sensor's zero is off
};

/// The one table of them.
std::span<const ParameterInfo> parameter_table();
const ParameterInfo& info(ParameterId id);
/// Of a key; empty where none has it.
std::optional<ParameterId> parameter_with_key(std::string_view key);

/// One parameter of a fit in SI units.
struct Parameter {
  ParameterId id{};
  Estimate estimate;
  ParameterStatus status = ParameterStatus::Unidentified;

  [[nodiscard]] std::string_view name() const { return info(id).key; }
};

/// Parameters that the user knows. SI; stiffness and frequency > 0, 0 <= damping ratio < 1.
struct HeldParameters {
  std::optional<double> stiffness_N_per_m{};
  std::optional<double> natural_frequency_rad_per_s{};
  std::optional<double> damping_ratio{};
};

/// What a model's covariance is of, in its order; of the positive ones the logarithm.
inline constexpr std::array kModelParameters{ParameterId::Stiffness,        ParameterId::NaturalFrequency,
                                             ParameterId::DampingRatio,     ParameterId::FrictionDifference,
                                             ParameterId::FrictionSlope,    ParameterId::Alpha,
                                             ParameterId::Ageing,           ParameterId::AgeingTime,
                                             ParameterId::ReloadForce,      ParameterId::ReloadLength,
                                             ParameterId::StiffnessExponent};
inline constexpr std::size_t kModelValues = kModelParameters.size();

/// The place of one of them.
constexpr std::size_t place_in_model(ParameterId id) {
  std::size_t place = 0;
  while (place < kModelValues && kModelParameters[place] != id) ++place;
  return place;
}

}  // namespace slipfit
