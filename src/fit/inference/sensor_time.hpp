#pragma once

#include <optional>

#include "fit/coordinates.hpp"
#include "fit/problem/block_fit.hpp"
#include "fit/selection/solution.hpp"

namespace slipfit::fit {

/// Standard error of the coordinate kSensorTime.
double sensor_time_error(const CoordinateMatrix& covariance);

/// The covariance with an error for the unknown shape of the instrument's impulse response: it moves the fitted time of
/// the sensor, and every coordinate that correlates with it.
CoordinateMatrix with_unknown_shape(const CoordinateMatrix& covariance, const BlockFit& fit);

/// The average that is a parameter of the fit; empty where it is none.
std::optional<FittedAverage> average_of(const BlockFit& fit, const CoordinateMatrix& covariance);

/// Returns the fit with the average that is a parameter of it, if it is one, and with what its unknown shape adds to
/// the covariance.
DampedFit with_average_error(DampedFit fit);

}  // namespace slipfit::fit
