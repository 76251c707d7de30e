#pragma once

#include <cstddef>
#include <optional>

#include "signal/phase_track.hpp"
#include "slipfit/core/recording.hpp"

namespace slipfit::signal {

/// Least squares of a harmonic series plus a straight line over the whole trace; for few cycles (the cost is cycles x
/// harmonics^3). The standard error allows for residuals correlated over up to one period. Empty: no convergence.
std::optional<TrackedFrequency> fit_harmonics(const Recording& recording, double near_Hz, std::size_t harmonics);

}  // namespace slipfit::signal
