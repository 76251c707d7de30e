#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "surface/mean_spacing.hpp"
#include "surface/ridges.hpp"

namespace slipfit::surface {

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
