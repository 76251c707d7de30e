#pragma once

#include <cstddef>

#include "core/common_thresholds.hpp"

/// Every number that decides what is a slip and which stretch slides; written as those of thresholds.hpp are.
namespace slipfit::thresholds {

// ## Slips in the trace

/// Rise between two falls over the smaller of them, below which they are one slip in two steps. [1; convention]
inline constexpr double kPauseRise = 0.5;

/// Rate of a rise over that of the fall before it, above which it belongs to ringing. [1; calibrated: measured slips
/// with ringing and benchmarks/independent, seeds 1 to 6]
inline constexpr double kRingingRise = 0.4;

/// Rate of the rises that are left over that of those that ring, below which something rings. [1; calibrated: as
/// kRingingRise]
inline constexpr double kRingApart = 0.15;

/// Rate of a rise over that of its fall, above which the fall is a wave's. [1; calibrated: as kRingingRise]
inline constexpr double kWaveRise = 0.65;

/// Median rate of the rises over that of the falls, above which there may be waves alone. [1; calibrated: as
/// kRingingRise]
inline constexpr double kSuddenRate = 0.3;

/// Time before a single fall over its own, below which it is none. [1; convention]
inline constexpr double kLeastAlone = 2.5;

/// Drop of a counted slip over the median drop, at least. [1; convention: docs/formats.md]
inline constexpr double kCountedDrop = 0.25;

/// Fewest slips that follow each other in a stretch that slides. [count; convention]
inline constexpr std::size_t kFewestInStretch = 4;

/// Duration of the stretch that slides over that of the recording, below which a reader is informed of it. [1;
/// convention]
inline constexpr double kMostlySliding = 0.8;

/// Interval over the long ones (90 % are shorter), and over the time of loading, above which a pause lies between two
/// slips. [1; convention]
inline constexpr double kLongestPauseRatio = 2.5;

/// Step from rest to sliding over how much the force moves while the body slides, above which a run without slips is
/// cut out. [1; convention]
inline constexpr double kPlateauStep = 3.0;

/// Fewest two-hundredths of a trace that make a plateau. [1; convention]
inline constexpr std::size_t kFewestPlateauBlocks = 20;

// ## What the falls show without a model

/// Falls below which their shape alone does not make stick-slip without a fit. [count; convention]
inline constexpr std::size_t kFewFalls = 10;

/// Root mean square drop over the range of the force, above which irregular falls are not the wander of a steady level.
/// [1; convention]
inline constexpr double kLargeSwing = 0.2;

/// Exponent of the second differences over their step, above which irregular swings are those of a body that moves.
/// [1; derived: between 0.5 of a random walk and 1.5 of straight sticks]
inline constexpr double kSmoothMotion = 1.0;

/// Share of the scatter of an interval that adds up from interval to interval, above which falls keep no clock's phase.
/// [1; derived: 0 for a clock read with noise, 1 for slips]
inline constexpr double kWalkShare = 0.2;

/// Relative distance of a measured and a stated path that are the same. [1; convention: a speed is known to 1 %]
inline constexpr double kSamePath = 0.02;

}  // namespace slipfit::thresholds
