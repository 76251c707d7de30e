#pragma once

#include <cstddef>

#include "core/common_thresholds.hpp"

/// Every number that decides what is a pattern on a worn surface; written as those of thresholds.hpp are.
namespace slipfit::thresholds {

// ## Pattern on a worn surface

/// Fewest points of a profile. [count; derived: five ridges of eight samples]
inline constexpr std::size_t kFewestPoints = 40;

/// Largest share of points that were not measured. [1; convention]
inline constexpr double kMostHoles = 0.1;

/// Fewest ridges on a track. [count; convention: as many features of one kind show how regular they are]
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

/// The same of a distance that a comb of lines has. [1; calibrated: controls of benchmarks/surface; without it one of
/// 800 has a confident wrong spacing]
inline constexpr double kHintOfRidges = -1.5;

/// Share of the best such logarithm, down to which a shorter smoothing is taken. [1; calibrated: benchmarks/surface,
/// seeds below 20]
inline constexpr double kKeptChance = 0.3;

/// Fewest samples of a ridge. [count; convention]
inline constexpr double kFewestRidgeSamples = 6.0;

/// Probability that a random surface shows such a comb of lines, below which it is believed. [1; convention]
inline constexpr double kSureComb = 1e-4;

/// Length of a ridge over their mean distance, below which it may be missed, and whose excess over the mean may be
/// taken for two. [1; calibrated: benchmarks/surface, seeds 31 to 33]
inline constexpr double kShortestSeen = 0.5;

/// Distance over that of the next coarser scale, above which it is the same pattern. [1; convention]
inline constexpr double kSameScale = 0.6;

/// Relative difference of two spacings, below which they are the same: at two smoothings, of ridges and a comb, of both
/// halves of a track, of track and slips. [1; convention]
inline constexpr double kSameSpacing = 0.15;

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

/// Reach of a ratio, above which no whole number is reported. [1; derived: half of it is the next number's]
inline constexpr double kWholeReach = 0.25;

}  // namespace slipfit::thresholds
