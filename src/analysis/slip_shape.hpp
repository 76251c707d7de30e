#pragma once

#include <vector>

#include "slipfit/signal/cycles.hpp"

namespace slipfit {

// What the shapes of the detected slips show, whatever model fits them.

/// Median; 0 where there are no slips.
double median_drop(const Segmentation& segmentation);

/// Seconds between the middles of neighbouring slips.
std::vector<double> slip_intervals_s(const Segmentation& segmentation);

/// Median interval between slips in periods of the mains, 50 or 60 Hz, whichever is nearer; 0 below 2 slips.
double mains_share(const Segmentation& segmentation);

/// How much longer the rises take than the falls before them: median; 0 where there are no rises.
double rise_over_fall(const Segmentation& segmentation);

/// Noise alone makes turning points of this size.
bool is_faint(const Segmentation& segmentation);

/// Falls as slow as those of a sine, over their period.
bool is_sine_like(const Segmentation& segmentation);

/// Intervals between the falls scatter no more than those of a repetition do.
bool keeps_rhythm(const Segmentation& segmentation);

/// Sudden falls after slow rises, in nearly all cycles: what makes stick-slip.
bool slips_are_sudden(const Segmentation& segmentation);

/// Falls well above the noise and quicker than a sine's: counting them gives the frequency of slips, not of noise or
/// hum.
bool slips_stand_out(const Segmentation& segmentation);

}  // namespace slipfit
