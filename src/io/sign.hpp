#pragma once

#include <cstddef>
#include <span>

namespace slipfit::reading {

/// A force that dwells at +F and at -F in turn: the strokes of a reciprocating test; else 1. A saw-tooth that swings
/// through zero has no strokes: it spends as much time near zero as anywhere.
std::size_t count_strokes(std::span<const double> force);

/// Of several strokes.
bool is_reciprocating(std::span<const double> force);

/// The force is measured with the other sign: at least 90 % of the samples are negative.
bool is_negative_throughout(std::span<const double> force);

}  // namespace slipfit::reading
