#pragma once

#include <span>
#include <vector>

#include "core/sample_range.hpp"

namespace slipfit::reading {

/// A stroke without the ends in which the force turns. Empty where it does nothing but turn.
struct Stroke : SampleRange {
  bool is_positive = true;
};

/// A force that dwells at +F and at -F in turn: the strokes of a reciprocating test; else none. A saw-tooth that swings
/// through zero has no strokes: it spends as much time near zero as anywhere.
std::vector<Stroke> find_strokes(std::span<const double> force);

/// The same of a recording that is told to be of strokes: whatever turns its sign, slips that nearly reach zero
/// included.
std::vector<Stroke> take_strokes(std::span<const double> force);

/// Of several strokes.
bool is_reciprocating(std::span<const double> force);

/// The force is measured with the other sign: at least 90 % of the samples are negative.
bool is_negative_throughout(std::span<const double> force);

/// More than half of the samples are negative.
bool is_mostly_negative(std::span<const double> force);

/// Which way the force changes much faster than the other, again and again.
enum class SuddenChanges { None, Falls, Rises };

/// By the skewness of the changes over some time: far from 0 with one sign, whichever sixteenth of the trace is left
/// out.
SuddenChanges sudden_changes(std::span<const double> force);

}  // namespace slipfit::reading
