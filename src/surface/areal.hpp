#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/thrown_error.hpp"
#include "slipfit/surface/surface.hpp"

namespace slipfit::surface {

/// The height of what was not measured.
constexpr double kHole = std::numeric_limits<double>::quiet_NaN();

/// Heights or grey values over an area, row by row; not a number where nothing was measured.
struct HeightMap {
  std::size_t columns = 0;
  std::size_t rows = 0;
  double x_pitch_m = 0.0;
  double y_pitch_m = 0.0;
  std::vector<double> values;
  bool in_metres = true;
};

constexpr std::size_t kMostPoints = std::size_t{64} << 20U;
constexpr std::size_t kMostInLine = std::size_t{4} << 20U;  ///< points of a profile, or of a line of an area
ThrownError map_too_large(const std::string& file);
/// Checks the size of an area. Error: map_too_large.
void check_extent(std::size_t columns, std::size_t rows, const std::string& file);

/// Returns all rows averaged across the sliding direction: the stated one, otherwise that in which the averages vary
/// most (after removal of the form). A single row is the profile itself.
Profile profile_of(const HeightMap& map, std::optional<double> along_rad);

/// Heights at these places, on even steps: unchanged if they are even, otherwise interpolated. Errors:
/// places_not_rising, no_unit.
Result<Profile> profile_of(std::vector<double> places_m, std::vector<double> heights, const std::string& file);

}  // namespace slipfit::surface
