#pragma once

#include <span>
#include <vector>

#include "core/sample_range.hpp"

namespace slipfit::reading {

/// A stroke without its ends, in which the drive turns and takes up the play. Empty where nothing else is in it.
struct Stroke : SampleRange {
  bool is_positive = true;
};

/// Force and displacement of a recording; the displacement is empty where the file holds none.
struct Motion {
  std::span<const double> force;
  std::span<const double> displacement;
};

/// The strokes of a recording that certainly is a reciprocating test: the displacement turns and the force changes
/// its side with it, or, where no displacement is known, the force dwells at +F and at -F in turn. Else none. A
/// saw-tooth that swings through zero has no strokes: it spends as much time near zero as anywhere. Neither has a run
/// between two rests whose sensor reads less than nothing at rest.
std::vector<Stroke> find_strokes(const Motion& motion);

/// The strokes of a recording that the user states to be of strokes: by the displacement where it turns, else by the
/// reversals of the force, slips that nearly reach zero included.
std::vector<Stroke> take_strokes(const Motion& motion);

/// Returns true if a recording contains several strokes.
bool is_reciprocating(const Motion& motion);

/// The force is measured with the other sign: at least 90 % of the samples are negative.
bool is_negative_throughout(std::span<const double> force);

/// Returns true if more than half of the samples are negative.
bool is_mostly_negative(std::span<const double> force);

/// The direction in which the force repeatedly changes much faster than in the other.
enum class SuddenChanges { None, Falls, Rises };

/// Returns the direction of sudden changes, by the skewness of the changes over some time: far from 0 with one sign,
/// whichever sixteenth of the trace is left out.
SuddenChanges sudden_changes(std::span<const double> force);

}  // namespace slipfit::reading
