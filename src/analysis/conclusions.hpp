#pragma once

#include <optional>
#include <span>
#include <vector>

#include "analysis/classify.hpp"
#include "analysis/detect.hpp"
#include "analysis/estimate.hpp"
#include "slipfit/analysis.hpp"
#include "slipfit/signal/cycles.hpp"

namespace slipfit {

// The results of an analysis other than its fit, in the order in which src/pipeline.cpp asks.

/// Both frequencies and the one to quote, which is of slips (or of an oscillation that is the motion): the cycles of a
/// fit that is the model's (`fitted_frequency`), or harmonic least squares where they are regular and it is the
/// sharper; without such a fit the count, or harmonic least squares where they agree on regular slips. Steady sliding
/// and undetermined motion have none, nor does a decaying motion if spectrum and count differ. `fit`: empty unless its
/// cycles are the model's.
FrequencyReport quote_frequency(const Recording& recording, const Signals& signals,
                                const Classification& classification, const FitResult* fit);

/// Frequency (Hz) from the cycles of the fit, with an interval that knows why periods scatter: the stick after a slip
/// lasts until the drop of that slip is made good, so that periods of neighbours are correlated, drops are not. Regular
/// cycles: a line through the onsets; scattering ones: their mean period, with the error of the mean drop. Empty below
/// 5 cycles, and where regular slips are not resolved.
std::optional<Estimate> fitted_frequency(const FitResult& fit, const Recording& recording);

/// Returns statistics of the detected slips; times of stick and slip are those of the fitted cycles if there is a fit.
CycleStatistics summarise_cycles(const Recording& recording, const Segmentation& segmentation, const FitResult* fit);

/// Returns the rhythm of slips with at least two intervals. `slips_Hz` is the reported frequency.
Regularity regularity_of(const CycleStatistics& cycles, const Estimate& slips_Hz, const Conditions& conditions);

/// Spacing V/f and impulse rate from the quoted frequency; uncertainty of the speed included where it is given.
Derived with_measured_spacing(Derived derived, const Recording& recording, const FrequencyReport& frequency,
                              const CycleStatistics& cycles);

/// Returns events outside the sliding part: the loading ramp and its first peak before it, and a free ring-down after
/// it (after the release, or after the last slip of a decaying motion).
Transients find_transients(const Detected& detected, MotionClass motion);

/// Returns the coefficients of friction; empty without a normal force (for a force column). `analysis` contains cycles,
/// transients and kind of motion.
std::optional<Coefficients> find_coefficients(const Detected& detected, const Analysis& analysis);

/// Numbers that no tester has, mostly from a unit that was mistaken: with the factor of 1000 that would mend them.
std::optional<std::string> implausible_units(const Recording& recording, const Analysis& analysis);

/// One-line tests of what the fit takes for granted (docs/accuracy.md): drift of the period, a cycle against the one
/// before, ageing; the stated mass and the load cell's resonance where they are stated; without a fit, whether the
/// level repeats. Empty unless the kind of motion is stick-slip.
std::vector<ShortTest> run_short_tests(const Recording& recording, const Analysis& analysis);

/// Does the force level of the slips repeat over the path (docs/accuracy.md)? `level_repeats`: the path from one
/// repetition to the next, in m. Beyond chance only where neither white scatter of the levels nor a random walk makes
/// such a sine. Empty below thresholds::kFewestOfLine slips.
std::optional<ShortTest> test_level_repeats(std::span<const Cycle> cycles, std::optional<double> speed_m_per_s);

}  // namespace slipfit
