#pragma once

#include <cstddef>

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

/// Hysteresis of turning points over the noise. [1; derived: noise makes no turning point of 8 standard deviations]
inline constexpr double kNoiseTurn = 8.0;

/// Fewest slips that follow each other in a stretch that slides. [count; convention]
inline constexpr std::size_t kFewestInStretch = 4;

/// Interval over the long ones (90 % are shorter), and over the time of loading, beyond which a pause lies between two
/// slips. [1; convention]
inline constexpr double kPatience = 2.5;

/// Step from rest to sliding over how much the force moves while the body slides, above which a run without slips is
/// cut out. [1; convention]
inline constexpr double kPlateauStep = 3.0;

/// Fewest two-hundredths of a trace that make a plateau. [1; convention]
inline constexpr std::size_t kFewestPlateauBlocks = 20;

}  // namespace slipfit::thresholds
