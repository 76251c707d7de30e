#include "fit/selection/solution.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/thresholds.hpp"

namespace slipfit::fit {

Recording with_average(const Recording& recording, double average_s) {
  Conditions conditions = recording.conditions();
  conditions.sensor_average_s = average_s;
  const auto time_s = recording.time_s();
  const auto force = recording.force();
  return Recording::create({time_s.begin(), time_s.end()}, {force.begin(), force.end()}, conditions,
                           recording.provenance())
      .value();
}

std::optional<Coordinates> moves_by(const DampedFit& fit, Coordinate coordinate) {
  constexpr double kMove = 0.01;  // of ln w_n or zeta
  BlockFit other = fit.blocks;
  other.parameters.values(coordinate) += kMove;
  if (!std::isfinite(solve(other, {fit.held, fit.continuous}))) return std::nullopt;
  return (coordinates_of(other) - coordinates_of(fit.blocks)) / kMove;
}

CoordinateMatrix with_unknown_shape(const CoordinateMatrix& covariance, const BlockFit& fit) {
  const double variance = covariance(kSensorTime, kSensorTime);
  if (!(variance > 0.0)) return covariance;
  const Coordinates by_shape =
      thresholds::kKernelShape * fit.parameters.values(kSensorTime) / variance * covariance.col(kSensorTime);
  return covariance + by_shape * by_shape.transpose();
}

std::optional<FittedAverage> average_of(const BlockFit& fit, const CoordinateMatrix& covariance) {
  const Scales& scales = fit.scales();
  if (scales.free_time != FreeTime::Average) return std::nullopt;
  const double unit_s2 = scales.sensor_time_unit_s * scales.sensor_time_unit_s;
  const double average_s = fit.sensor().average_s;
  const double error = std::sqrt(std::max(0.0, covariance(kSensorTime, kSensorTime)));
  return FittedAverage{average_s, 0.5 * unit_s2 * error / average_s};
}

DampedFit with_average_error(DampedFit fit) {
  fit.uncertainty.covariance = with_unknown_shape(fit.uncertainty.covariance, fit.blocks);
  const std::optional<FittedAverage> average = average_of(fit.blocks, fit.uncertainty.covariance);
  if (average) fit.average = average;
  return fit;
}

}  // namespace slipfit::fit
