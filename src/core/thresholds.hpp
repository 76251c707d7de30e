#pragma once

#include <cstddef>

/// Every number that decides a kind of motion, a slip, a status, a tier, a warning, a pattern or which frequency is
/// quoted. Each comment says what is compared, and in brackets unit and origin: derived (from the model), convention,
/// or calibrated (on what). scripts/thresholds.py makes docs/thresholds.md from this file.

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

/// Fewest samples of a slip that time it and show its shape, and of a ridge. [count; derived: onset, fall and end are
/// two each]
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

/// Twice the logarithm of the likelihood of a straight rise over that of half a cosine, or of a fit with a lag over
/// that without, below which the two cannot be distinguished. [1; convention: odds of ten to one]
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

/// Relative distance of frequencies, or of lengths of waves, that are the same. [1; convention]
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

/// Smallest relative change, or difference of two measures of a spacing, that is reported. [1; convention]
inline constexpr double kNotableChange = 0.2;

/// Mean length of a run of equal values, from which on the logger is quicker than the converter. [samples; convention]
inline constexpr double kShortestRepeat = 1.5;

/// Usual change from run to run over the smallest one, below which values repeat because they are rounded.
/// [1; convention]
inline constexpr double kRoundingSteps = 3.0;

// ## Before and after the sliding

/// Rise of a run-up over the usual drop of a slip. [1; convention: a stick rises by about one drop]
inline constexpr double kRunUp = 1.5;

/// Largest share of a recording without slips after its first peak that has fallen back to a quarter of the rise: the
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

/// Averaging time of the sensor and a step of the clock over the period of a swing, above which straight sticks cannot
/// be distinguished from it. [1; derived: a fall lasts as long as the average at least, and its rounded ends as long
/// again on either side]
inline constexpr double kAverageOfSwing = 0.25;

// ## Slips in the trace

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

/// Duration of the stretch that slides over that of the recording, below which a reader is informed of it. [1;
/// convention]
inline constexpr double kMostlySliding = 0.8;

/// Interval over the long ones (90 % are shorter), and over the time of loading, above which a pause lies between two
/// slips. [1; convention]
inline constexpr double kLongestPauseRatio = 2.5;

/// Fewest two-hundredths of a trace that make a plateau. [1; convention]
inline constexpr std::size_t kFewestPlateauBlocks = 20;

// ## What the falls show without a model

/// Falls below which their shape alone makes stick-slip without a fit only where they are twice as sudden as kSudden.
/// [count; convention]
inline constexpr std::size_t kFewFalls = 10;

/// Root mean square drop over the range of the force, above which irregular falls are not the wander of a steady level.
/// [1; convention]
inline constexpr double kLargeSwing = 0.2;

/// Slope of the middle of a rise over that from its trough to its peak, below which the force wanders and the body does
/// not stick. [1; calibrated: below 0.34 where the force of a friction damper wanders, above 0.52 for bent sticks, 1
/// for straight ones]
inline constexpr double kSteadyRise = 0.4;

/// Exponent of the second differences over their step, above which irregular swings are those of a body that moves.
/// [1; derived: between 0.5 of a random walk and 1.5 of straight sticks]
inline constexpr double kSmoothMotion = 1.0;

/// The same exponent, below which swings far above the noise are those of a body that rings. [1; derived: between 0 of
/// white noise and 0.5 of a random walk]
inline constexpr double kRoughMotion = 0.25;

/// Share of the scatter of an interval that adds up from interval to interval, above which falls keep no clock's phase.
/// [1; derived: 0 for a clock read with noise, 1 for slips]
inline constexpr double kWalkShare = 0.2;

// ## Which cycles and samples are fitted

/// Mean square residual of a cycle over the median of all, above which the fit leaves it out. [1; derived: 5 standard
/// deviations on average over a whole cycle]
inline constexpr double kUnexplainedRatio = 25.0;

// ## Level and mains in the fit

/// Reduced chi2 above which the level model is questionable. [1; derived: noise alone gives 1 +- sqrt(2 / samples), and
/// the noise measured from differences is good to a few percent]
inline constexpr double kSuspectChi2 = 1.2;

/// F ratio of one level a cycle against the polynomial, above which the level wanders. [1; derived: far beyond chance
/// for 12 and more cycles]
inline constexpr double kWanderingRatio = 3.0;

/// Residual of the polynomial through the middles of the slips over the drop, above which the level wanders. [1;
/// convention]
inline constexpr double kWanderingShare = 0.03;

/// Residual of that polynomial over the noise, above which the level wanders. [1; convention]
inline constexpr double kWanderingNoises = 10.0;

/// Power of a mains line in the residuals over its surroundings, above which it is fitted. [1; derived: 2e-9 by chance
/// in white noise]
inline constexpr double kSureHum = 20.0;

/// Power of a line at another frequency, as kSureHum. [1; derived: 1e-9 by chance in white noise of a million bins]
inline constexpr double kSureLine = 70.0;

/// Mean of the unit vectors of a line's phases at the onsets of the slips, up to which it has nothing to do with them.
/// [1; derived: exceeded with exp(-0.25 n) by chance with n cycles]
inline constexpr double kNoPhase = 0.5;

/// Share of the power of a line that the residuals keep without what repeats from cycle to cycle, up to which the line
/// belongs to the shape of the cycles. [1; convention: half]
inline constexpr double kUnlikeCycles = 0.5;

/// Fewest cycles with which a line, or a wave of the level, is sought. [count; derived: exp(-0.25 n) is a percent of
/// chance there]
inline constexpr std::size_t kFewestOfLine = 16;

/// Mean of the unit vectors of a line's phases at the onsets of the slips, above which it is in step with them.
/// [1; derived: exp(-0.81 n) by chance with n cycles]
inline constexpr double kInStep = 0.9;

// ## Tier

/// Samples of a slip, below which w_n and zeta have no single minimum. [count; calibrated: simulated slips of few
/// samples]
inline constexpr double kResolvedSamples = 1.5;

/// Standard error of zeta, below which scattering cycles determine it even then. [1; calibrated: as kResolvedSamples]
inline constexpr double kPinningDamping = 0.01;

/// Standard error of zeta, from which on it is not reported. [1; convention: zeta of a slip that shows itself is below
/// 0.5]
inline constexpr double kInformativeDamping = 0.1;

// ## Intervals

/// Relative standard error of alpha, from which on its interval comes from a profile. [1; calibrated: sweep_coverage]
inline constexpr double kKnownRate = 0.15;

/// Chance of a mean residual in one of eight parts of the slip, below which an average does not explain the slips.
/// [1; derived: that of kOfManySigmas for many cycles, in eight parts]
inline constexpr double kMisfitChance = 5e-5;

/// Stacked residual of the slips under friction that weakens over a slip distance over that under Coulomb friction, at
/// most. [1; convention: what is left is smaller than what is explained]
inline constexpr double kHalvedStack = 0.5;

/// Share of a trend that a measured load leaves unexplained, below which the trend is friction. [1; convention: a
/// sensor zero of a tenth of the force does as much]
inline constexpr double kLoadShare = 0.1;

/// Relative standard error of a mass that is stated without one (Conditions::mass_standard_error_kg). [1; convention]
inline constexpr double kUsualMassError = 0.02;

/// Factor either way, above which the band of a predicted spacing or of the end of stick-slip says nothing; its square
/// for an end that goes as an exponential of what ages. [1; convention]
inline constexpr double kWidestFactor = 2.0;

// ## Status of a parameter

/// Fewest samples of a slip whose shape identifies a parameter, and which an average over one of them moves in
/// proportion to its square; and of the length over which the force rises after a slip. [count; calibrated: at 3
/// samples that are averaged over a step of the clock, intervals of w_n fail; at 4 they hold]
inline constexpr double kSlipSamples = 3.5;

/// Relative standard error, above which a bound says more than an interval, and 0 is not excluded. [1; derived: 3
/// standard errors]
inline constexpr double kInformativeError = 1.0 / 3.0;

/// Share of the variance of an instrument's impulse response for which its unknown shape counts. [1; convention: the
/// variance is all that counts to second order]
inline constexpr double kKernelShape = 0.03;

/// Reduced chi2 above which residuals are warned of. [1; calibrated: at most 1.21 for 480 recordings inside the model]
inline constexpr double kLargeChi2 = 2.0;

// ## Sweeps

/// Scatter of friction from one recording to the next, over its mean, that few recordings are judged with. [1;
/// convention: repeatability within a laboratory of 9 to 13 % in the VAMAS round robin, Czichos et al. 1987]
inline constexpr double kUsualScatter = 0.1;

/// Ratio of frequencies at one speed (to a ratio of 1.3) from which on the speeds are doubted: F_s - F_k and k would
/// have to scatter as much. [1; convention]
inline constexpr double kOneSpeedFrequencies = 2.0;

/// F_s - F_k that moves by more with the law of kinetic friction below the measured speeds is not identified.
/// [1; convention]
inline constexpr double kOtherLawShare = 0.02;

/// Reduced chi2 of a sweep, above which its model leaves something out. [1; convention: the noise is that of each
/// recording's own fit]
inline constexpr double kSweepMisfit = 1.5;

/// Averaging time of the samples times w_n, above which a stated mass gives w_n: the fall of an averaged slip is then
/// longer by the average than by itself. [1; derived]
inline constexpr double kHidingAverage = 2.0;

/// Residual with w_n by a stated mass over that with w_n free, above which the mass is not that of the slips. [1;
/// convention]
inline constexpr double kContradictedMass = 1.25;

/// Standard error of ln w_n from which on slips do not determine whether a ring-down is their motion: another mode of
/// the rig would agree by chance. [1; derived: 3 of them are a factor of 1.6]
inline constexpr double kInformativeFrequency = 0.15;

/// Chance below which the static friction of recordings at several speeds does not lie on a line within their own
/// errors. [1; convention]
inline constexpr double kAgeingChance = 0.05;

/// Chance below which ageing has a cut-off. [1; derived: taken wrongly in one sweep of 200]
inline constexpr double kCutoffChance = 0.005;

/// Least ratio of the longest stick of a sweep to the shortest that distinguishes its cut-off from another law of
/// ageing. [1; convention]
inline constexpr double kCutoffStickRatio = 30.0;

/// Least recordings that show a trend of static friction over the speed. [1; convention: two always lie on a line]
inline constexpr std::size_t kTrendRecordings = 3;

/// Least ratio of their speeds for either. [1; convention]
inline constexpr double kTrendSpeedRatio = 2.0;

/// Relative difference of the spacing of a recording from that which the others predict, above which it may be wrong.
/// [1; calibrated: benchmarks/independent/sweeps.py]
inline constexpr double kLeftOutShare = 0.02;

/// The factor by which a recording has to be further away than half of the recordings: if most are far away, the model
/// lacks something and no recording is wrong. [1; calibrated: as above, four false alarms in 332 sweeps of other seeds]
inline constexpr double kDistinctRatio = 8.0;

/// Share of the squared distances of the recordings that a line over ln V holds, above which none is named. [1;
/// derived: one recording apart at an end of four leaves it 0.6]
inline constexpr double kGoesWithSpeed = 0.9;

/// ln of the ratio of speeds from which on an end of the sweep determines how far its law extends. [1; convention]
inline constexpr double kBeyondDistance = 0.1;

// ## Predictions

/// Ratio of a speed to the nearest one of a sweep, up to which a sweep that cannot show a trend of static friction has
/// intervals. [1; convention]
inline constexpr double kUntrendedRatio = 1.5;

/// Share of the span of a sweep's speeds, in ln V, at which a trend beyond them begins before their ends. [1; derived:
/// half the distance of neighbours of four recordings]
inline constexpr double kTrendBegins = 1.0 / 6.0;

/// Ratio to the nearest speed of a sweep, above which a prediction is said to be far. [1; convention]
inline constexpr double kFarRatio = 4.0;

/// Half-width of the 95 % interval of d ln(F_s - F_k) / d ln V where only one speed was measured: static friction that
/// ages and kinetic friction that depends on the speed. [1; derived: docs/model.md section 13]
inline constexpr double kFrictionTrend = 0.33;

/// Half-width of the 95 % interval of d ln k / d ln V for an unmeasured dependence of k on the rate. [1; derived: as
/// kFrictionTrend]
inline constexpr double kStiffnessTrend = 0.15;

/// Half-width of the 95 % interval of d ln F_k / d ln V for an unmeasured velocity dependence. [1; derived: as
/// kFrictionTrend]
inline constexpr double kKineticTrend = 0.04;

/// Least relative standard error of a weak parameter at other speeds than the only one measured; of a conditional one
/// it is the limit of identified. [1; convention: the largest limit of identified of the parameters that a slip shows]
inline constexpr double kWeakError = 0.25;

/// Reach of alpha V, above which linear propagation does not hold. [1; calibrated: up to it bands hold 93 % or more of
/// the motions that the covariance allows, at 1.6 88 %, at 2.4 84 % (tests/predict)]
inline constexpr double kStraightLaw = 0.7;

/// Share of the models that the data allow, below which those that stick at a speed give no intervals. [1; convention:
/// 40 of the 800 drawn]
inline constexpr double kLeastSticking = 0.05;

/// Standard error over what noise and scatter explain, above which misfit limits a parameter. [1; convention]
inline constexpr double kUnexplainedError = 2.0;

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

/// Reach of a ratio, above which no whole number is reported. [1; derived: half of it is the next number's]
inline constexpr double kWholeReach = 0.25;

}  // namespace slipfit::thresholds
