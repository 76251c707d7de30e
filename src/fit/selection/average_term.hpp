#pragma once

#include <optional>

#include "fit/selection/rise_term.hpp"
#include "fit/selection/solution.hpp"

namespace slipfit::fit {

/// Returns whether the average of the fit is so long (thresholds::kHidingAverage) that damped slips behind it look like
/// longer ones without damping.
bool hides_damping(const BlockFit& fit);

/// Its variance, which is what rounds the slips, is more than kClearSigmas of its errors: T_b itself, a root, is twice
/// as many of its own.
bool average_is_identifiable(const FittedAverage& average);

/// `plain` finished, with the average that the slips show where the recording states none. Where one is not ruled out,
/// intervals hold what it would make of the slips.
std::optional<DampedFit> fit_as_sensed(const FitInput& input, DampedFit plain);

/// Returns the finished fit of a draft whose rise is known only together with an average. Empty where it is not known
/// so, either.
std::optional<DampedFit> rise_behind_average(const FitInput& input, const RiseDraft& draft);

/// Rounding to steps of the converter repeats its errors in every cycle: their scatter does not show how well averaging
/// is known.
bool repeats_rounding(const DampedFit& fit);

/// sigma^2 of averaging that may be in the slips, stated by nobody and not in the fit, where they show `seen`: one step
/// of the clock, which most instruments average over, or what they do not exclude where their best estimate is more.
double unstated_variance_s2(const DampedFit& fit, const Smoothing& seen, double sample_interval_s);

}  // namespace slipfit::fit
