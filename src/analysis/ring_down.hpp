#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "analysis/detect.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/fit/ring_down.hpp"

namespace slipfit {

/// An oscillation exp(-decay t) (a cos(omega t) + b sin(omega t)) on a straight line, with standard errors.
struct DampedSine {
  double omega_rad_per_s = 0.0, omega_error_rad_per_s = 0.0;
  double decay_per_s = 0.0, decay_error_per_s = 0.0;
  double half_periods = 0.0;  ///< that the samples reach over
};

/// Least squares from a start; errors by leaving out each half period in turn, which sees an oscillation that changes
/// with its size, and by the residuals, whichever are larger. Empty where it does not converge near the start.
std::optional<DampedSine> fit_damped_sine(std::span<const double> time_s, std::span<const double> force,
                                          double omega_rad_per_s, double decay_per_s);

/// Detects the ring-down after the release of a recording that sticks and slips to the end of its sliding; empty
/// without one.
std::optional<RingDown> ring_down_after_release(const Detected& detected);

}  // namespace slipfit
