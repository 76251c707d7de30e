#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace slipfit::surface {

/// The ridges that a profile shows between two wavelengths. Places in samples of the profile.
struct Ridges {
  double smoothed_over = 0.0;                        ///< cut-off of the Gaussian filter that takes the roughness
  double waves_above = 0.0;                          ///< cut-off of the one that takes form and waviness
  std::vector<double> peaks, falls, valleys, rises;  ///< places; falls and rises at half of their height
  std::vector<double> heights;                       ///< peak over the valley behind it

  [[nodiscard]] std::size_t count() const { return peaks.size(); }
};

/// Finds ridges in `heights` without form. Turning points count from 0.3 of the usual amplitude on; ridges cut by the
/// ends of the profile are left out.
Ridges find_ridges(std::span<const double> heights, double smoothed_over, double waves_above);

std::vector<double> distances(std::span<const double> places);

/// Returns the standard deviation over the mean; 0 for fewer than two values.
double variation(std::span<const double> values);

}  // namespace slipfit::surface
