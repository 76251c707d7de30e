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

/// Returns the strokes of a recording that certainly is a reciprocating test, otherwise nothing: the displacement turns
/// and the force changes its side with it; or the force stays at +F and at -F in turn; or it slips towards the middle
/// from either side of it. A saw-tooth that swings through zero falls on both sides. A run between two rests whose
/// sensor reads less than zero at rest does not slip there.
std::vector<Stroke> find_strokes(const Motion& motion);

/// The strokes of a recording that the user states to be of strokes: by the displacement where it turns, else by the
/// reversals of the force, slips that nearly reach zero included.
std::vector<Stroke> take_strokes(const Motion& motion);
}  // namespace slipfit::reading
