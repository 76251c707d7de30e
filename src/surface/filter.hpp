#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace slipfit::surface {

/// Returns the mean line of the Gaussian filter of ISO 16610-21, which transmits half of a wave at the cut-off. Lengths
/// are in samples; weights extend one cut-off to either side and are normalised at the ends.
std::vector<double> gaussian_mean(std::span<const double> heights, double cutoff);

/// Returns means over blocks of equal size, without the last incomplete block.
std::vector<double> block_means(std::span<const double> heights, std::size_t block);

/// A mean line of a long cut-off, computed on block means a sixty-fourth of it and joined by lines: within 0.1 % of the
/// wave's height of the filter itself.
std::vector<double> waviness(std::span<const double> heights, double cutoff);

/// Returns the heights without the least-squares parabola, the form of a bent or tilted specimen.
std::vector<double> without_form(std::span<const double> heights);

}  // namespace slipfit::surface
