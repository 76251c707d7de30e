#pragma once

#include <cstddef>

#include "core/common_thresholds.hpp"

/// Every number that decides a kind of motion, a status, a tier, a warning or which frequency is quoted. Each comment
/// says what is compared, and in brackets unit and origin: derived (from the model), convention, or calibrated (on
/// what). scripts/thresholds.py makes docs/thresholds.md from this file.
namespace slipfit::thresholds {

// ## Kind of motion

/// Largest residual over onset force of a close fit. [1; calibrated: below 0.03 for simulated, 0.04 to 0.10 for
/// measured stick-slip, above 0.15 for noise, hum and random walks (docs/accuracy.md)]
inline constexpr double kCloseFit = 0.1;

/// Largest residual over onset force of a loose fit. [1; calibrated: as kCloseFit]
inline constexpr double kLooseFit = 0.2;

/// Largest spread of the onset force over its mean. [1; calibrated: as kCloseFit]
inline constexpr double kWideSpread = 0.7;

/// Smallest share of slips that come to rest in stick-slip. [1; convention]
inline constexpr double kRestickShare = 0.8;

/// Time of a fall from 80 % to 20 % over the period, above which a trace is as round as a sine. [1; derived: 0.205 for
/// a sine, 0.3 for an even triangle, less for slips]
inline constexpr double kSineFall = 0.17;

/// Largest residual over onset force where falls are as slow as a sine's. [1; calibrated: below 0.02 for simulated
/// cycles just above the limit of stick-slip]
inline constexpr double kSineFit = 0.05;

/// Largest residual of three sines over the swing of a wave without sticks. [1; derived: a jump of the acceleration at
/// the begin of a stick leaves some 1/64 of its share of the cycle, so that this is a stick of a hundredth]
inline constexpr double kPureWave = 1e-4;

/// Twice the logarithm of the likelihood of sticks and slips over that of three harmonics, or of a straight rise over
/// that of half a cosine, below which the two cannot be distinguished. [1; convention: odds of ten to one]
inline constexpr double kEvidence = 4.6;

/// Share of the recording that cycles have to cover: swings that end earlier died out. [1; convention]
inline constexpr double kSpanShare = 0.5;

/// Relative distance of the cycles' rhythm from the mains', below which round swings may be its hum. [1; derived: the
/// mains keeps its frequency to 0.1 %, intervals of few samples are less exact]
inline constexpr double kMainsRhythm = 5e-3;

/// Drop over noise, below which turning points may be noise alone. [1; calibrated: white and
/// correlated noise of tests/failures]
inline constexpr double kNoiseDrop = 14.0;

/// Time of a rise over that of a fall, above which falls are sudden. [1; derived: 1 for waves and noise, at least 2.3
/// for straight sticks where falls are quicker than kSineFall]
inline constexpr double kSudden = 3.0;

/// Smallest share of falls with half of kSudden. [1; convention]
inline constexpr double kSuddenShare = 0.9;

/// Time of a rise over that of a fall, below which a trace rises as suddenly as it falls. [1; derived: 1 for square
/// waves]
inline constexpr double kSquare = 1.3;

/// Scatter over mean of the intervals of what repeats. [1; convention: 1 for random times, 0.5 for noise]
inline constexpr double kRhythm = 0.25;

/// Fewest samples of a recording that is analysed. [count; convention: two periods of eight samples]
inline constexpr std::size_t kFewestSamples = 16;

/// Fewest samples of a cycle that shows slips. [count; derived: rise and fall take two each]
inline constexpr double kFewestCycleSamples = 4.0;

// ## Quoted frequency

/// Scatter over mean of the intervals, above which slips are counted even if there is a fit. [1; convention]
inline constexpr double kCounted = 0.15;

/// Drop over noise of a sample, below which noise conceals slips. [1; calibrated: simulated slips are missed below 3]
inline constexpr double kHiding = 6.0;

/// Relative distance of frequencies that are the same. [1; convention]
inline constexpr double kAlike = 0.05;

/// Spectrum over count less one, above which the repetition is another thing than the slips (pick-up, ringing).
/// [1; convention]
inline constexpr double kAnotherThing = 2.0;

/// Spread of the onset force over its error, above which periods scatter. [1; derived: beyond chance from 10 cycles on]
inline constexpr double kOrdinarySpread = 2.0;

/// Log likelihood that phases gain by a walk, below which they show none. [1; derived: even phases gain more in one
/// recording of seven]
inline constexpr double kWalkGain = 1.0;

/// Power of the likelihood where they show none: friction that scatters by a ten-thousandth of the drop does not show.
/// [1; calibrated: benchmarks/frequency_coverage, 90 % of the intervals hold with 0.7]
inline constexpr double kHiddenWalk = 0.35;

// ## Quality and spectrum

/// Largest share of values that differ in a recording of rounded values. [1; convention]
inline constexpr double kDistinctShare = 0.05;

/// Largest distance of a rounded value from its lattice over the step. [1; derived: what a file's decimals may move it]
inline constexpr double kOffLattice = 0.1;

/// Samples at such a level over those at the next value. [1; convention]
inline constexpr double kClippedPile = 6.0;

/// Share of the energy of a line at the mains that one quarter of the recording holds, above which it is no mains.
/// [1; derived: a line that is there for half of the recording has at most half of its energy in each of two quarters]
inline constexpr double kBurst = 0.7;

/// Fewest cycles of a repetition in the spectrum. [count; derived: fewer cannot be distinguished from wander]
inline constexpr double kFewestPeriods = 2.5;

// ## Slips and what changes on the way

/// Largest number of drive periods to a slip. [count; convention]
inline constexpr double kMostDriveSteps = 10.0;

/// Relative standard error of the slips' frequency, times the number of drive periods to a slip, up to which agreement
/// with the drive is no chance. [1; derived: neighbouring multiples are 1 / (number of periods) apart, 2 standard
/// errors either side are a fifth of it]
inline constexpr double kSureOfDrive = 0.05;

/// Step of the clock over its median, above which it is a gap. [1; convention]
inline constexpr double kGapSteps = 3.5;

/// Median deviation over median of intervals that are regular. [1; convention]
inline constexpr double kRegularRest = 0.03;

/// Distance from the median of a broken interval among regular ones, over the median. [1; convention]
inline constexpr double kFarInterval = 0.12;

/// The same of a broken interval between two usual ones. [1; convention]
inline constexpr double kOddInterval = 0.04;

/// Distance of either over the typical distance of the intervals, at least. [1; convention]
inline constexpr double kFarOverTypical = 8.0;

/// Standard errors between two parts of a recording that differ. [1; derived: the best of many splits reaches 3 to 4 by
/// chance]
inline constexpr double kBeyondScatter = 6.0;

/// Smallest relative change that is reported. [1; convention]
inline constexpr double kNotableChange = 0.2;

/// Mean length of a run of equal values, from which on the logger is quicker than the converter. [samples; convention]
inline constexpr double kShortestRepeat = 1.5;

/// Usual change from run to run over the smallest one, below which values repeat because they are rounded.
/// [1; convention]
inline constexpr double kRoundingSteps = 3.0;

// ## Before and after the sliding

/// Rise of a run-up over the usual drop of a slip. [1; convention: a stick rises by about one drop]
inline constexpr double kRunUp = 1.5;

/// Largest share of a recording without slips behind its first peak that has fallen back to a quarter of the rise: the
/// release at its end. [1; convention]
inline constexpr double kReleased = 0.2;

/// Fewest half periods of a ring-down, the first one aside. [count; convention]
inline constexpr std::size_t kFewestSwings = 4;

/// Natural frequency of the slips over that of the rig's free ring-down, below which slips are not inertial.
/// [1; convention: stiffness and mass differ by less than a factor of four between the two]
inline constexpr double kInertialSlip = 0.5;

// ## Fit beneath the mains

/// Misfit beneath the mains over that of the trace as it is, below which it is kept. [1; calibrated: lines in the level
/// take up some noise by themselves]
inline constexpr double kClearlyBetter = 0.95;

// ## Measured drive

/// Deviation of a measured drive from a steady motion at the stated speed, as a force over the median drop or as a
/// speed over the stated one, below which the stated speed is used. [1; convention: a speed is known to 1 %]
inline constexpr double kSteadyDrive = 0.01;

/// Force by which a measured drive moves in a slip over the drop of the slip, above which what the slips show is
/// conditional. [1; calibrated: below it w_n of servo_dips in benchmarks/independent is within 0.5 %]
inline constexpr double kDriveInSlip = 0.1;

// ## Warnings

/// Time constants of the sensor in a cycle, below which it is too slow. [1; derived: 8 pass before a ramp is fitted,
/// and the slip takes some]
inline constexpr double kLagsOfCycle = 14.0;

/// Fewest pairs of cycles of a short test. [count; convention]
inline constexpr std::size_t kFewestPairs = 8;

/// Smallest swing of a wave of the level over the mean drop. [1; convention: between two samples of a slip a peak is
/// read too low by up to as much]
inline constexpr double kSmallestWave = 0.05;

/// Largest relative difference of what two recordings repeat over, for it to be one thing. [1; convention]
inline constexpr double kOneWave = 0.05;

/// Fewest waves of the level in a recording: fewer are a drift. [count; convention]
inline constexpr double kFewestWaves = 3.0;

/// Most waves over slips. [1; derived: beyond half of the slips two frequencies look alike]
inline constexpr double kMostWaves = 0.45;

/// Frequency of the slips over the sensor's resonance, from which on they are shown too large. [1; derived: by
/// 1 / (1 - 0.09), 10 %, there]
inline constexpr double kNearResonance = 0.3;

/// Speeds closer than this ratio say nothing about how the frequency follows. [1; convention]
inline constexpr double kLeastSpeedRatio = 1.3;

/// Samples of a fall, below which it is as long as the clock makes it. [count; convention]
inline constexpr double kSamplesOfFall = 4.0;

/// Averaging time of the sensor over the period of a swing, above which straight sticks cannot be distinguished from
/// it. [1; derived: a fall lasts as long as the average at least, and its rounded ends as long again on either side]
inline constexpr double kAverageOfSwing = 0.25;

}  // namespace slipfit::thresholds
