#pragma once

#include <cstddef>
#include <optional>

#include "slipfit/core/estimate.hpp"
#include "slipfit/core/recording.hpp"

namespace slipfit {

/// A free oscillation that dies out.
struct RingDown {
  Estimate frequency_Hz;  ///< of the damped oscillation
  Estimate damping_ratio;
};

/// After the largest fall behind `begin` (sample), where it is at least `least_fall`: half periods between turning
/// points, and the logarithmic decrement of the swings between them, the first one aside (the contact still holds).
/// Intervals from their scatter, so that a ring whose frequency or damping changes with its size has wide ones. Empty
/// where fewer than four swings that shrink stand out of the noise.
std::optional<RingDown> find_ring_down(const Recording& recording, std::size_t begin, double noise, double least_fall);

}  // namespace slipfit
