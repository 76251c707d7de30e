#pragma once

#include <span>
#include <vector>

#include "core/sample_range.hpp"
#include "signal/events.hpp"

namespace slipfit::signal {

/// The stretch in which slips follow each other: without the loading ramp before the first, without what comes after
/// the last (stop, release and its ring-down, steady sliding), and the longest of several (pauses, strokes). The whole
/// trace where fewer than 4 falls follow each other, and where less than a usual stick of ordinary force would be cut.
SampleRange sliding_stretch(const std::vector<double>& force, const std::vector<Fall>& falls);

/// The longest stretch at the level of sliding, where the force has two levels, one near zero, far apart compared with
/// how it moves at the upper one: a run without slips between rest, loading and release. The whole trace where it has
/// not.
SampleRange plateau(std::span<const double> force);

}  // namespace slipfit::signal
