#pragma once

#include <optional>
#include <span>

namespace slipfit::surface {

/// Cut-off of ISO 21920-3 (ISO 4288) for profile elements of this mean width: at least twice it.
double standard_cutoff_m(double element_m);

/// RSm: mean width of the elements (a peak and an adjacent valley) of a profile about its mean line, in samples. Parts
/// within a tenth of Rz of the mean line, or shorter than a hundredth of a sampling length, belong to their neighbours.
/// `sampling` in samples. Empty: fewer than two whole elements.
std::optional<double> mean_element_width(std::span<const double> heights, double sampling);

}  // namespace slipfit::surface
