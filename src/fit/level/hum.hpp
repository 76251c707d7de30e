#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "fit/problem/block_fit.hpp"
#include "slipfit/core/recording.hpp"

namespace slipfit::fit {

/// A line that a drive may make which runs unevenly: V (1 + r cos w t) gives a force k V r / w in stick.
struct DriveRipple {
  double frequency_Hz = 0.0;
  double speed_share = 0.0;  ///< amplitude of the speed that makes it, over the driving speed
};

/// Returns the frequencies of the mains lines that are prominent in the residuals, and of the strongest line at another
/// frequency where it is larger than the noise, unless they are in step with the slips.
/// Small hum is masked by the cycles' own spectrum, but not in the residuals. Lines that the fit has already are looked
/// at again, so that their frequency follows the better fit.
///
/// A line that is not fitted yet has images: at multiples of the slips' frequency from it, because cycles take up part
/// of it in numbers of their own, and near it where there are gaps between the fitted cycles. They go when the line is
/// fitted. So only lines are taken that nothing near exceeds by far.
///
/// `residuals`: one a sample (Residuals::value), handed over because a long recording has no room for a copy.
std::vector<double> find_hum(const Recording& recording, const BlockFit& fit, std::vector<double> residuals,
                             const std::vector<std::size_t>& outliers);

/// Returns the frequencies at which the residuals of the fit, as for find_hum, have the lines that it has already.
std::vector<double> refine_hum(const Recording& recording, const BlockFit& fit, std::vector<double> residuals);

/// Returns the amplitude of the fitted lines that belong to the mains, in the unit of the force.
double mains_amplitude(const BlockFit& fit);
/// FitDiagnostics::stick_slope_by_lines, of a line through so many seconds.
double slope_by_lines(const BlockFit& fit, double length_s);

/// Coefficients of the level for lines of these frequencies, where a fit that follows may begin: the lines that `fit`
/// has come first, in its order, with the same phase in the middle of the recording; others are 0.
std::vector<double> hum_at_other_frequencies(const BlockFit& fit, const std::vector<double>& frequencies_Hz);

/// Returns whether the fit has lines at these frequencies already, up to a difference that is small against the noise.
bool is_same_hum(const BlockFit& fit, const std::vector<double>& frequencies_Hz);

/// The largest fitted line that a drive may make: its speed changes by more than thresholds::kNegligible and never
/// turns back; not of the mains.
std::optional<DriveRipple> fitted_ripple(const BlockFit& fit);

}  // namespace slipfit::fit
