#pragma once

#include <optional>

#include "fit/coordinates.hpp"
#include "fit/problem/block_fit.hpp"
#include "fit/selection/solution.hpp"

namespace slipfit::fit {

/// Standard error of the coordinate kSensorTime.
double sensor_time_error(const CoordinateMatrix& covariance);

/// The unknown shape of the instrument's impulse response adds to the error of the time of the sensor that the fit
/// found and to all that goes with it.
CoordinateMatrix with_unknown_shape(const CoordinateMatrix& covariance, const BlockFit& fit);

/// The average that is a parameter of the fit; empty where it is none.
std::optional<FittedAverage> average_of(const BlockFit& fit, const CoordinateMatrix& covariance);

}  // namespace slipfit::fit
