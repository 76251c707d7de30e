#pragma once

#include <cstddef>

/// Every number that decides what is a pattern on a worn surface; written as those of thresholds.hpp are.
namespace slipfit::thresholds {

// ## Pattern on a worn surface

/// Fewest points of a profile. [count; derived: five ridges of eight samples]
inline constexpr std::size_t kFewestPoints = 40;

/// Largest share of points that were not measured. [1; convention]
inline constexpr double kMostHoles = 0.1;

/// Fewest ridges on a track. [count; convention]
inline constexpr double kFewestOnTrack = 5.0;

/// Fewest ridges that are looked at for how regular they are. [count; convention]
inline constexpr std::size_t kFewestRidges = 6;

/// Swing of a turn over the usual swing, from which on it is a ridge. [1; convention]
inline constexpr double kRidgeSwing = 0.3;

/// Scatter over mean of the distances of ridges on random surfaces: 0.39 in the median at every scale, above 0.30 in 95
/// of 100; a smaller one is taken. [1; calibrated: white, Gaussian, exponential and fractal profiles, grooves at random
/// places]
inline constexpr double kRandomVariation = 0.33;

/// ln of the probability that a random surface has ridges as regular, below which they are a pattern. [1; derived:
/// exp(-7) for each of some 30 scales with four features]
inline constexpr double kPatternChance = -7.0;

/// The same of a distance that a comb of lines has. [1; calibrated: controls of benchmarks/surface]
inline constexpr double kHintOfRidges = -1.5;

/// Share of the best such logarithm, down to which a shorter smoothing is taken. [1; calibrated: benchmarks/surface,
/// seeds below 20]
inline constexpr double kKeptChance = 0.3;

/// Fewest samples of a ridge. [count; convention]
inline constexpr double kFewestRidgeSamples = 6.0;

/// Fewest samples of a ridge that only the spectrum shows. [count; calibrated: controls of benchmarks/surface]
inline constexpr double kFewestCombSamples = 10.0;

/// Fewest ridges that only the spectrum shows: the phase of fewer is even by luck. [count; calibrated:
/// benchmarks/surface]
inline constexpr double kFewestCombRidges = 12.0;

/// Probability that a random surface shows such a comb of lines, below which it is believed. [1; convention]
inline constexpr double kSureComb = 1e-4;

/// Scatter of the distances over their mean that a comb may describe: its phase is followed from ridge to ridge. [1;
/// derived: three times it is half a turn, above which a step could be the opposite one]
inline constexpr double kFollowedScatter = 1.0 / 6.0;

/// The same below which a comb whose phase does not wander is taken, whatever the ridges scatter by: roughness moves
/// their places and their count. [1; calibrated: benchmarks/surface, seeds 11 to 14: even ridges stay below 0.012]
inline constexpr double kEvenScatter = 0.015;

/// Smoothing over the distance, above which a comb has to show the ridges too. [1; calibrated: as kKeptChance]
inline constexpr double kMuchSmoothing = 0.25;

/// Length of a ridge over their mean distance, below which it may be missed, and whose excess over the mean may be
/// taken for two. [1; calibrated: benchmarks/surface, seeds 31 to 33]
inline constexpr double kShortestSeen = 0.5;

/// Distance over that of the next coarser scale, above which it is the same pattern. [1; convention]
inline constexpr double kSameScale = 0.6;

/// Relative difference of the distances at two smoothings, below which the ridges are the same. [1; convention]
inline constexpr double kSameRidges = 0.3;

/// Relative difference of a comb's spacing and the distance of the ridges, below which they agree. [1; convention]
inline constexpr double kCombAgrees = 0.15;

/// The same if only the comb shows the ridges. [1; convention]
inline constexpr double kCombRidges = 0.1;

/// Ratio of two spacings, above which the finer may be a pattern of its own. [1; convention]
inline constexpr double kFinerPattern = 2.5;

/// Largest ratio that may be an overtone: edges of the coarser pattern. [1; convention]
inline constexpr double kHighestOvertone = 12.5;

/// Distance of the ratio from a whole number, below which it is one. [1; convention]
inline constexpr double kOvertoneApart = 0.15;

/// Height of finer ridges over that of coarser ones that may be every second or third of them, above which the finer
/// are the pattern. [1; convention]
inline constexpr double kHigherRidges = 1.5;

/// Scatter of the distances over their mean, from which on a pattern is called irregular. [1; convention]
inline constexpr double kIrregular = 0.2;

/// Relative difference of RSm and the spacing, above which it is warned of. [1; convention]
inline constexpr double kRsmApart = 0.2;

/// Difference of the spacings at both ends over its standard error, above which it is warned of. [1; convention]
inline constexpr double kDrifts = 3.0;

/// Relative difference of two spacings, below which they are nearly the same. [1; convention]
inline constexpr double kNearlySame = 0.15;

/// Largest whole number of slips to a ridge, or of ridges to a slip, that is reported. [count; convention]
inline constexpr double kMostSlipsToRidge = 12.0;

/// Reach of a ratio, above which no whole number is reported. [1; derived: half of it is the next number's]
inline constexpr double kWholeReach = 0.25;

}  // namespace slipfit::thresholds
