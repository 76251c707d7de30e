#pragma once

#include <cstddef>
#include <optional>

#include "analysis/detect.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/fit/ring_down.hpp"

namespace slipfit {

/// After the largest fall behind `begin` (sample), where it is at least `least_fall`: half periods between turning
/// points, and the logarithmic decrement of the swings between them, the first one aside (the contact still holds).
/// Intervals from their scatter, so that a ring whose frequency or damping changes with its size has wide ones. Empty
/// where fewer than four swings that shrink stand out of the noise.
std::optional<RingDown> find_ring_down(const Recording& recording, std::size_t begin, double noise, double least_fall);

/// After the release of a recording that sticks and slips to the end of its sliding; empty without one.
std::optional<RingDown> ring_down_after_release(const Detected& detected);

}  // namespace slipfit
