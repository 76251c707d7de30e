#pragma once

#include <span>

namespace slipfit::reading {

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
