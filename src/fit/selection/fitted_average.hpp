#pragma once

#include <optional>

#include "fit/selection/solution.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/fit/parameter.hpp"
#include "slipfit/signal/cycles.hpp"
#include "slipfit/signal/quality.hpp"

namespace slipfit::fit {

/// With an average of this variance as a parameter of the fit that its model has, and what W is not known by in the
/// covariance. `beyond`: what is left to smooth.
DampedFit with_average_error(DampedFit fit, double variance_s2, const Smoothing& beyond);

/// Its variance, which is what rounds the slips, is more than kSureTerm of its errors: T_b itself, a root, is twice as
/// many of its own.
bool tells_average(const FittedAverage& average);

/// What an average of the instrument explains that a fit without does not.
struct AverageTrial {
  std::optional<DampedFit> fit{};    ///< empty: not taken
  std::optional<DampedFit> rival{};  ///< not taken, but not ruled out, though its w_n and zeta are others
};

/// The fit with one parameter more, the time W over which the instrument averages its samples (docs/model.md section
/// 7), where it is not stated and `plain`, the fit without, shows a sign of it. Its covariance holds that of W. Not
/// taken where W does not explain all that `plain` misses of the slips or a sensor of first order explains it as well.
/// Where W cannot be told from the slips behind it, or another W explains them as well, DampedFit::fall_doubt says so.
AverageTrial try_average(const Recording& recording, const Quality& quality, const Segmentation& segmentation,
                         const HeldParameters& held, const DampedFit& plain);

/// `plain` finished, with the average that the slips show where the recording states none. Where one is not ruled out,
/// intervals hold what it would make of the slips.
std::optional<DampedFit> fit_as_sensed(const Recording& recording, const Quality& quality,
                                       const Segmentation& segmentation, const HeldParameters& held, DampedFit plain);

/// Rounding to steps of the converter repeats its errors in every cycle: their scatter does not show how well averaging
/// is known.
bool repeats_rounding(const DampedFit& fit);

/// sigma^2 of averaging that may be in the slips, stated by nobody and not in the fit, where they show `seen`: one step
/// of the clock, which most instruments average over, or what they do not exclude where their best estimate is more.
double unstated_variance_s2(const DampedFit& fit, const Smoothing& seen, double sample_interval_s);

}  // namespace slipfit::fit
