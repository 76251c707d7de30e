#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace slipfit::surface {

/// Mean line of the Gaussian filter of ISO 16610-21: half of a wave as long as the cut-off passes. Lengths in samples;
/// weights reach one cut-off to either side and are normalised at the ends.
std::vector<double> gaussian_mean(std::span<const double> heights, double cutoff);

/// Means over blocks of equal size, the last incomplete block left out.
std::vector<double> block_means(std::span<const double> heights, std::size_t block);

/// A mean line of a long cut-off, computed on block means a sixty-fourth of it and joined by lines: within 0.1 % of the
/// wave's height of the filter itself.
std::vector<double> waviness(std::span<const double> heights, double cutoff);

/// Less the parabola of least squares: the form of a bent or tilted specimen.
std::vector<double> without_form(std::span<const double> heights);

}  // namespace slipfit::surface
