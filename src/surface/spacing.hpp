#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "slipfit/core/estimate.hpp"

namespace slipfit::surface {

/// The mean of a series of distances between neighbours, and its uncertainty.
struct MeanSpacing {
  double value = 0.0;
  double standard_error = 0.0;  ///< half of the 95 % interval over kNormalQuantile
  Interval ci95;
  double clock_share = 0.0;  ///< probability that the positions scatter around even marks
};

/// Properties of the marks by the spectrum, if their positions scatter around even ones.
struct Clock {
  double spacing = 0.0;
  double standard_error = 0.0;
};

/// Distances of neighbouring ridges depend on each other: a ridge found too late makes one longer and the next shorter
/// (correlation down to -1/2), the middle of a ridge moves with the widths of two (up to +1/2). The mean is that of a
/// normal series with such a correlation of neighbours, averaged over what the data say of it (mixture of t
/// distributions). Priors are flat in the mean, in the scatter (in its logarithm, few distances that are alike by luck
/// would have too small an interval) and in the correlation, with half of the weight on that of a clock. `miscount` is
/// the standard error that ridges seen double or not at all add. Empty: fewer than 4 distances.
std::optional<MeanSpacing> mean_spacing(std::span<const double> distances, const std::optional<Clock>& clock = {},
                                        double miscount = 0.0);

/// The ridges that a profile shows between two wavelengths. Places in samples of the profile.
struct Ridges {
  double smoothed_over = 0.0;                        ///< cut-off of the Gaussian filter that takes the roughness
  std::vector<double> peaks, falls, valleys, rises;  ///< places; falls and rises at half of their height
  std::vector<double> heights;                       ///< peak over the valley after it

  [[nodiscard]] std::size_t count() const { return peaks.size(); }
};

std::vector<double> distances(std::span<const double> places);

/// Returns the standard deviation over the mean; 0 for fewer than two values.
double variation(std::span<const double> values);

/// A pattern that repeats along the profile, at one scale. Lengths in samples.
struct Pattern {
  Ridges ridges;
  std::vector<double>
      places;  ///< of the feature of the ridges that is second in regularity: peaks, falls, valleys or rises
  double variation = 0.0;  ///< of the distances of these places
  /// ln of the probability that the ridges of a random surface are as regular as these.
  double log_chance = 0.0;
  std::optional<MeanSpacing> spacing;  ///< empty: the ridges do not determine it
  bool is_from_comb = false;           ///< the spacing is that of the lines of the spectrum, else of the ridges
  double comb_spacing = 0.0;           ///< of lines without ridges
  std::string doubt;                   ///< why the spacing is not known
};

/// Returns the distance from the first to the last position over their number; 0 for fewer than two.
double mean_distance(const Pattern& pattern);

/// The patterns of a profile without form, the coarsest first; of each scale one.
std::vector<Pattern> find_patterns(std::span<const double> heights);

}  // namespace slipfit::surface
