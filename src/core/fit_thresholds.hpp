#pragma once

#include <cstddef>

#include "core/common_thresholds.hpp"

/// Limits that decide in the fit and in what follows from it, in the form of thresholds.hpp.
namespace slipfit::thresholds {

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

/// Fewest cycles with which a line, or a wave of the level, is sought. [count; derived: exp(-0.25 n) is a percent of
/// chance there]
inline constexpr std::size_t kFewestOfLine = 16;

/// Power of a line over that of the strongest in the same residuals, below which it may be an image of it. [1;
/// calibrated: images are below 0.022 for 60 simulated recordings with hum]
inline constexpr double kHumImage = 0.1;

/// Mean of the unit vectors of a line's phases at the onsets of the slips, above which it is in step with them.
/// [1; derived: exp(-0.81 n) by chance with n cycles]
inline constexpr double kInStep = 0.9;

/// Power of fitted hum over that of the residuals, above which outliers are looked for again. [1; convention]
inline constexpr double kBlurringHum = 0.5;

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

/// Least k of another reading of a trend, over that of the fit. [1; convention: a trend as steep as the sticks]
inline constexpr double kLeastStiffness = 0.01;

/// Relative standard error of a mass that is stated without one (Conditions::mass_standard_error_kg). [1; convention]
inline constexpr double kUsualMassError = 0.02;

/// Chance at which a line in the sticks is none. [1; convention]
inline constexpr double kRippleChance = 1e-6;

/// Share of the speed by which a drive swings, above which slips are known to start at other speeds. [1; convention]
inline constexpr double kRippleShare = 0.02;

/// Factor either way, above which the band of a predicted spacing or of the end of stick-slip says nothing; its square
/// for an end that goes as an exponential of what ages. [1; convention]
inline constexpr double kWidestFactor = 2.0;

// ## Status of a parameter

/// Fewest samples of a slip whose shape identifies a parameter. [count; calibrated: at 3 samples that are averaged over
/// a step of the clock, intervals of w_n fail; at 4 they hold]
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

/// Chi-square by which a fit with an average is worse and not ruled out. [1; convention: 95 % of one parameter]
inline constexpr double kNotRuledOut = 3.84;

/// Residual with w_n by a stated mass over that with w_n free, above which the mass is not that of the slips. [1;
/// convention]
inline constexpr double kContradictedMass = 1.25;

/// Standard error of ln w_n from which on slips do not determine whether a ring-down is their motion: another mode of
/// the rig would agree by chance. [1; derived: 3 of them are a factor of 1.6]
inline constexpr double kInformativeFrequency = 0.15;

/// Chance below which static friction that differs between the speeds ages. [1; convention: static friction of polymers
/// and rubber does]
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

/// Errors by which the spacing predicted without a recording may differ from its own, above which it disagrees with
/// the others. [1; calibrated: benchmarks/independent/sweeps.py]
inline constexpr double kLeftOutErrors = 5.0;

/// Least relative difference for that. [1; calibrated: as above]
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

}  // namespace slipfit::thresholds
