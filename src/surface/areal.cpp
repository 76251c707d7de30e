#include "surface/areal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/clock_step.hpp"
#include "surface/filter.hpp"

namespace slipfit::surface {
namespace {

/// Averages over lines across one direction, at equal steps along it.
struct Projection {
  double step_m = 0.0;
  std::vector<double> means;
  std::vector<double> counts;
};

Projection project(const HeightMap& map, double along_rad, std::size_t thinned) {
  const double c = std::cos(along_rad) * map.x_pitch_m;
  const double s = std::sin(along_rad) * map.y_pitch_m;
  Projection projection{std::hypot(c, s), {}, {}};
  const double reach =
      std::abs(c) * static_cast<double>(map.columns - 1) + std::abs(s) * static_cast<double>(map.rows - 1);
  projection.means.assign(static_cast<std::size_t>(reach / projection.step_m) + 2, 0.0);
  projection.counts.assign(projection.means.size(), 0.0);
  const double first =
      std::min(0.0, c * static_cast<double>(map.columns - 1)) + std::min(0.0, s * static_cast<double>(map.rows - 1));
  for (std::size_t row = 0; row < map.rows; row += thinned) {
    for (std::size_t column = 0; column < map.columns; column += 1) {
      const double value = map.values[row * map.columns + column];
      if (!std::isfinite(value)) continue;
      const double place = (c * static_cast<double>(column) + s * static_cast<double>(row) - first) / projection.step_m;
      const auto at = static_cast<std::size_t>(std::max(0.0, place));
      const double share = place - static_cast<double>(at);
      projection.means[at] += (1.0 - share) * value;
      projection.counts[at] += 1.0 - share;
      if (share == 0.0) continue;
      projection.means[at + 1] += share * value;
      projection.counts[at + 1] += share;
    }
  }
  return projection;
}

/// Returns the projection without the corners, to which few rows contribute; gaps remain gaps.
Projection trimmed(Projection projection) {
  const double most = *std::ranges::max_element(projection.counts);
  const auto is_full = [most](double count) { return count >= 0.5 * most; };
  const auto first = std::ranges::find_if(projection.counts, is_full);
  const auto last = std::find_if(projection.counts.rbegin(), projection.counts.rend(), is_full).base();
  const auto begin = first - projection.counts.begin();
  const auto end = last - projection.counts.begin();
  Projection result{projection.step_m, {}, {}};
  for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
    const double count = projection.counts[i];
    result.means.push_back(count >= 0.1 * most ? projection.means[i] / count : kHole);
    result.counts.push_back(count);
  }
  return result;
}

/// Returns the variance of the averages after removal of the form.
double variance_along(const HeightMap& map, double along_rad, std::size_t thinned) {
  Projection projection = trimmed(project(map, along_rad, thinned));
  std::vector<double>& means = projection.means;
  if (means.size() < 8) return 0.0;
  for (std::size_t i = 0; i < means.size(); ++i) {
    if (!std::isfinite(means[i])) means[i] = i > 0 && std::isfinite(means[i - 1]) ? means[i - 1] : 0.0;
  }
  double sum = 0.0;
  for (const double value : without_form(means)) sum += value * value;
  return sum / static_cast<double>(means.size());
}

/// In steps of two degrees over half a turn, then of a tenth around the best.
double find_direction(const HeightMap& map) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  const std::size_t thinned = 1 + map.values.size() / 1000000;  // rows left out, for the search only
  double best = 0.0;
  double highest = -1.0;
  const auto look = [&](double angle) {
    const double variance = variance_along(map, angle, thinned);
    if (variance <= highest) return;
    highest = variance;
    best = angle;
  };
  for (int k = -44; k <= 45; ++k) look(2.0 * k * kDegree);
  const double middle = best;
  for (int k = -20; k <= 20; ++k) look(middle + 0.1 * k * kDegree);
  return best;
}

}  // namespace

ThrownError map_too_large(const std::string& file) {
  return ThrownError({"map_too_large", fmt::format("{}: has more than {} million points, or more than {} million in "
                                                   "one line; crop it to the track, or use fewer points",
                                                   file, kMostPoints >> 20U, kMostInLine >> 20U)});
}

void check_extent(std::size_t columns, std::size_t rows, const std::string& file) {
  if (columns > kMostInLine || rows > kMostInLine || columns * rows > kMostPoints) throw map_too_large(file);
}

Profile profile_of(const HeightMap& map, std::optional<double> along_rad) {
  Profile profile;
  profile.height_in_metres = map.in_metres;
  profile.rows = std::min(map.rows, map.columns);
  if (map.rows == 1 || map.columns == 1) {
    profile.pitch_m = map.rows == 1 ? map.x_pitch_m : map.y_pitch_m;
    profile.height = map.values;
    profile.rows = 1;
    return profile;
  }
  const double along = along_rad.value_or(0.0);
  profile.along_rad = along_rad ? along : find_direction(map);
  const double degrees = *profile.along_rad * 180.0 / std::numbers::pi;
  if (!along_rad) {
    profile.assumed.push_back(
        fmt::format("The sliding direction is {:.1f} degrees from the x axis, the direction in which the averaged "
                    "heights vary most (--along).",
                    degrees));
  }
  Projection projection = trimmed(project(map, *profile.along_rad, 1));
  profile.pitch_m = projection.step_m;
  profile.height = std::move(projection.means);
  profile.assumed.push_back(fmt::format("All {} points were averaged across that direction.", map.values.size()));
  return profile;
}

Result<Profile> profile_of(std::vector<double> places_m, std::vector<double> heights, const std::string& file) {
  if (places_m.size() < 2)
    return Error{"too_few_points", file + ": contains fewer than two points; measure a longer track"};
  if (places_m.front() > places_m.back()) {
    std::ranges::reverse(places_m);
    std::ranges::reverse(heights);
  }
  for (std::size_t i = 1; i < places_m.size(); ++i) {
    if (places_m[i] > places_m[i - 1]) continue;
    return Error{"places_not_rising",
                 fmt::format("{}: the positions along the track do not increase from point {} to the next; give one "
                             "profile, or name its columns with --x-column and --z-column",
                             file, i)};
  }
  Profile profile;
  const double length_m = places_m.back() - places_m.front();
  const auto steps = static_cast<double>(places_m.size() - 1);
  double off = 0.0;
  for (std::size_t i = 0; i < places_m.size(); ++i) {
    off = std::max(off, std::abs(places_m[i] - places_m.front() - length_m * static_cast<double>(i) / steps));
  }
  profile.pitch_m = length_m / steps;
  profile.height = std::move(heights);
  if (off <= 0.25 * profile.pitch_m) return profile;
  profile.pitch_m = std::max(median_positive_step(places_m), 0.5 * profile.pitch_m);
  const std::vector<double> given = std::move(profile.height);
  profile.height.clear();
  std::size_t right = 1;
  for (double place = places_m.front(); place <= places_m.back(); place += profile.pitch_m) {
    while (right + 1 < places_m.size() && places_m[right] < place) ++right;
    const double gap = places_m[right] - places_m[right - 1];
    const double share = std::clamp((place - places_m[right - 1]) / gap, 0.0, 1.0);
    // Points far apart have a hole between them.
    const bool is_hole = gap > 3.5 * profile.pitch_m && share > 0.0 && share < 1.0;
    profile.height.push_back(is_hole ? kHole : given[right - 1] + share * (given[right] - given[right - 1]));
  }
  profile.assumed.emplace_back(
      "The positions along the track are uneven: the heights were interpolated to even steps.");
  return profile;
}

}  // namespace slipfit::surface
