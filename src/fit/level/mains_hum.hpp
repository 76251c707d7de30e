#pragma once

#include <optional>
#include <vector>

#include "fit/level/stick_ripple.hpp"
#include "fit/problem/block_fit.hpp"

namespace slipfit::fit {

/// Returns the amplitude of all fitted lines together, in the unit of the force; it is 0 without lines.
double hum_amplitude(const BlockFit& fit);
/// Returns the amplitude of the fitted lines that belong to the mains, in the unit of the force.
double mains_amplitude(const BlockFit& fit);
/// FitDiagnostics::stick_slope_by_lines, of a line through so many seconds.
double slope_by_lines(const BlockFit& fit, double length_s);

/// Coefficients of the level for lines of these frequencies, where a fit that follows may begin: the lines that `fit`
/// has come first, in its order, with the same phase in the middle of the recording; others are 0.
std::vector<double> hum_at_other_frequencies(const BlockFit& fit, const std::vector<double>& frequencies_Hz);

/// Returns whether the fit has lines at these frequencies already, up to a difference that is small against the noise.
bool is_same_hum(const BlockFit& fit, const std::vector<double>& frequencies_Hz);

/// The largest fitted line that a drive may make: its speed changes by more than thresholds::kRippleShare and never
/// turns back; not of the mains.
std::optional<StickRipple> fitted_ripple(const BlockFit& fit);

}  // namespace slipfit::fit
