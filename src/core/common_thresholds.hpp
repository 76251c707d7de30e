#pragma once

#include <cstddef>

/// Numbers that decide in several places; written as those of thresholds.hpp are.
namespace slipfit::thresholds {

// ## Significance, and what does not matter

/// Standard errors that are unlikely by chance: of the rounding of slips, of a zeta below 0. [1; derived: 0.6 % by
/// chance]
inline constexpr double kLikelySigmas = 2.5;

/// Standard errors of a term of the model, of a bend of the sticks, of a change along a track, or of the spread of the
/// onset forces, above which it is there. [1; derived: 0.3 % by chance]
inline constexpr double kClearSigmas = 3.0;

/// Standard errors of a correlation of residuals, of a trend of the level, or between two values of one quantity, above
/// which chance is ruled out. [1; derived: 6e-5 by chance]
inline constexpr double kSureSigmas = 4.0;

/// Standard errors of the largest of many deviations, above which chance is ruled out: of a sample, of a part of the
/// slip, of a recording left out. [1; derived: 7e-6 by chance for each]
inline constexpr double kOfManySigmas = 4.5;

/// Standard deviations of the noise that no sample of it reaches. [1; derived: white noise of a million samples stays
/// below 5, measured noise has tails]
inline constexpr double kNoiseSigmas = 8.0;

/// Chance below which a finding is proven. [1; convention]
inline constexpr double kProven = 1e-3;

/// Chance below which one model is preferred to another, or a repetition to noise. [1; convention]
inline constexpr double kSignificant = 0.01;

/// AICc or BIC by which a model with more terms has to be better. [1; convention: 10 is "essentially no support" for
/// the poorer one, Burnham and Anderson 2002]
inline constexpr double kTierPrice = 10.0;

/// Relative difference or effect that does not matter. [1; convention]
inline constexpr double kNegligible = 0.01;

/// Fewest slips of a kind of motion, and cycles of a fit. [count; derived: scatter over cycles needs two degrees of
/// freedom]
inline constexpr std::size_t kFewestSlips = 3;

/// Fewest cycles of an identified parameter, of a fitted frequency, and of falls that are called sudden. [count;
/// derived: below it a scatter is known to a factor of two only]
inline constexpr std::size_t kFewestCycles = 5;

/// Fewest samples of a slip that time it and show its shape. [count; derived: onset, fall and end are two each]
inline constexpr double kShapeSamples = 6.0;

/// Fewest samples of half a period that show its peaks, and straight sticks. [count; derived: peaks are met to
/// (pi / 20)^2 / 2 = 1 %]
inline constexpr double kWellSampled = 10.0;

/// Relative spread of the time step, above which the clock is uneven, and samples on steep parts weigh less. [1;
/// convention]
inline constexpr double kUnevenClock = 0.02;

/// Scatter of the periods, over the period, below which what repeats keeps time like a clock. [1; convention: pick-up
/// and drives scatter by less, friction by more]
inline constexpr double kClockScatter = 0.01;

/// Relative distance of spectrum and count that show the same rhythm, and scatter over mean of intervals that keep one.
/// [1; convention]
inline constexpr double kSameRhythm = 0.1;

/// Least number of recordings that show a dependence on speed, and of which one can be named as wrong. [count; derived:
/// a line through three has one degree of freedom left; of three, any two may agree by chance]
inline constexpr std::size_t kFewestRecordings = 4;

}  // namespace slipfit::thresholds
