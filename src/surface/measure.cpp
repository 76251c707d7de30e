#include "surface/measure.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/statistics.hpp"
#include "core/thresholds.hpp"
#include "core/unknown.hpp"
#include "signal/defects.hpp"
#include "signal/smoothing.hpp"
#include "slipfit/core/range.hpp"
#include "slipfit/surface/surface.hpp"
#include "surface/filter.hpp"
#include "surface/spacing.hpp"

namespace slipfit::surface {

namespace {

/// Rz: mean over the sampling lengths of highest peak above lowest valley.
double mean_height(std::span<const double> heights, std::size_t sampling) {
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t begin = 0; begin + sampling <= heights.size(); begin += sampling) {
    const auto [low, high] = std::ranges::minmax_element(heights.subspan(begin, sampling));
    sum += *high - *low;
    count += 1.0;
  }
  return count > 0.0 ? sum / count : 0.0;
}

}  // namespace

double standard_cutoff_m(double element_m) {
  constexpr std::array kSeries_m = {25e-6, 80e-6, 250e-6, 800e-6, 2.5e-3, 8e-3, 25e-3};
  const auto found = std::ranges::find_if(kSeries_m, [&](double c) { return c >= 2.0 * element_m; });
  return found == kSeries_m.end() ? kSeries_m.back() : *found;
}

std::optional<double> mean_element_width(std::span<const double> heights, double sampling) {
  const auto length = static_cast<std::size_t>(std::max(1.0, sampling));
  const double level = 0.1 * mean_height(heights, length);
  if (!(level > 0.0)) return std::nullopt;
  const double shortest = 0.01 * sampling;
  std::vector<double> begins;  // where the profile rises through the mean line into a peak that counts
  bool is_below = false;
  std::size_t crossed = 0;
  for (std::size_t i = 1; i < heights.size(); ++i) {
    if (heights[i - 1] < 0.0 && heights[i] >= 0.0) crossed = i;
    if (heights[i] < -level) is_below = true;
    const bool is_long = begins.empty() || static_cast<double>(crossed) - begins.back() >= shortest;
    if (heights[i] > level && is_below && is_long) {
      begins.push_back(static_cast<double>(crossed));
      is_below = false;
    }
  }
  if (begins.size() < 3) return std::nullopt;
  return (begins.back() - begins.front()) / static_cast<double>(begins.size() - 1);
}

}  // namespace slipfit::surface

namespace slipfit {

namespace {

using surface::Pattern;

constexpr Range kPositive{1e-300, 1e300};

Error too_few_ridges(const Profile& profile, double count) {
  return {"too_few_ridges", fmt::format("{}: the track has only about {:.0f} ridges; fewer than {} do not "
                                        "determine the spacing; measure a longer track",
                                        profile.file, count, thresholds::kFewestRidges)};
}

std::optional<Error> refusal(const Profile& profile) {
  const std::vector<double>& z = profile.height;
  const auto holes = static_cast<std::size_t>(std::ranges::count_if(z, [](double h) { return !std::isfinite(h); }));
  if (z.size() < thresholds::kFewestPoints) {
    return Error{"too_few_points",
                 fmt::format("{}: {} points are too few for a pattern (at least {}); measure a longer "
                             "track or at a smaller pitch",
                             profile.file, z.size(), thresholds::kFewestPoints)};
  }
  if (static_cast<double>(holes) > thresholds::kMostHoles * static_cast<double>(z.size())) {
    return Error{"too_many_holes",
                 fmt::format("{}: {:.0f} % of the points were not measured, at most a tenth is interpolated; measure "
                             "the track again or crop it to its good part",
                             profile.file, 100.0 * static_cast<double>(holes) / static_cast<double>(z.size()))};
  }
  const auto known = std::ranges::find_if(z, [](double h) { return std::isfinite(h); });
  if (std::ranges::all_of(z, [&](double h) { return !std::isfinite(h) || h == *known; })) {
    return Error{
        "constant_profile",
        profile.file + ": all heights are equal; check the column (--z-column) and the range of the instrument"};
  }
  return std::nullopt;
}

/// Interpolates missing heights linearly.
std::vector<double> without_holes(const std::vector<double>& heights) {
  std::vector<bool> missing(heights.size());
  std::transform(heights.begin(), heights.end(), missing.begin(), [](double h) { return !std::isfinite(h); });
  return signal::bridged(heights, missing);
}

Estimate estimate(const surface::MeanSpacing& mean, double scale) {
  return within(scaled(Estimate{mean.value, mean.standard_error, mean.ci95, {}}, scale), kPositive);
}

/// Returns the mean height of the ridges above the next valley; neighbours are treated as independent.
Estimate mean_height(const std::vector<double>& heights) {
  const auto n = static_cast<double>(heights.size());
  const double mean = mean_of(heights);
  return within(symmetric(mean, mean * surface::variation(heights) / std::sqrt(n)), kNotNegative);
}

struct Trend {
  Estimate begin, end;
};

/// A straight line through the distances over their places along the track.
Trend trend_of(const std::vector<double>& distances, double pitch_m) {
  const LineSums line = line_sums(
      distances.size(), [](std::size_t i) { return static_cast<double>(i); },
      [&](std::size_t i) { return distances[i]; });
  const double error = std::sqrt(line.variance() * (1.0 / line.count + line.mean_x * line.mean_x / line.square));
  const auto at = [&](double index) { return within(symmetric(line.at(index) * pitch_m, error * pitch_m), kPositive); };
  return {at(0.0), at(line.count - 1.0)};
}

/// Median length of a rise over that of a fall.
std::optional<double> asymmetry_of(const surface::Ridges& ridges) {
  std::vector<double> rises;
  std::vector<double> falls;
  for (std::size_t i = 0; i < ridges.peaks.size(); ++i) {
    falls.push_back(ridges.valleys[i] - ridges.peaks[i]);
    if (i > 0) rises.push_back(ridges.peaks[i] - ridges.valleys[i - 1]);
  }
  if (rises.empty()) return std::nullopt;
  const double fall = signal::median(falls);
  return fall > 0.0 ? std::optional(signal::median(rises) / fall) : std::nullopt;
}

/// RSm of the profile about the mean line of a standard cut-off; of the profile's own length where that is shorter.
void add_rsm(const Profile& profile, const std::vector<double>& heights, double element_m, Surface& found) {
  const double length_m = profile.pitch_m * static_cast<double>(heights.size());
  const double cutoff_m = std::min(surface::standard_cutoff_m(element_m), length_m / 3.0);
  found.cutoff_m = cutoff_m;
  std::vector<double> rough = heights;
  const std::vector<double> waves = surface::waviness(heights, std::max(2.0, cutoff_m / profile.pitch_m));
  for (std::size_t i = 0; i < rough.size(); ++i) rough[i] -= waves[i];
  if (const auto width = surface::mean_element_width(rough, cutoff_m / profile.pitch_m)) {
    found.rsm_m = *width * profile.pitch_m;
  }
}

void add_ridges(const Profile& profile, const Pattern& pattern, Surface& found) {
  const surface::Ridges& ridges = pattern.ridges;
  found.ridges = ridges.count();
  for (const double place : ridges.peaks) found.ridge_places_m.push_back(place * profile.pitch_m);
  found.ridge_height = mean_height(ridges.heights);
  if (!profile.height_in_metres) found.ridge_height.note = "in the unit of the file: not known in metres";
  found.asymmetry = asymmetry_of(ridges);
  found.smoothed_over_m = ridges.smoothed_over * profile.pitch_m;
  const std::vector<double> apart = surface::distances(pattern.places);
  found.spacing_sd_m = pattern.variation * surface::mean_distance(pattern) * profile.pitch_m;
  const Trend trend = trend_of(apart, profile.pitch_m);
  found.begin_spacing_m = trend.begin;
  found.end_spacing_m = trend.end;
}

/// A spacing that what coded the file has by itself.
bool is_of_the_code(const Profile& profile, const surface::MeanSpacing& spacing) {
  if (!profile.block_samples) return false;
  constexpr std::array kBlocks = {1.0, 2.0};
  return std::ranges::any_of(kBlocks, [&](double blocks) {
    const double apart = std::abs(spacing.value - blocks * *profile.block_samples);
    return apart < std::max(2.0 * spacing.standard_error, 0.01 * spacing.value);
  });
}

void conclude(const Profile& profile, const std::vector<Pattern>& patterns, Surface& found) {
  if (patterns.empty()) {
    found.status = SurfaceStatus::None;
    found.spacing_m = unknown("nothing repeats more regularly than on a random surface");
    return;
  }
  const Pattern& pattern = patterns.front();
  if (!pattern.spacing) {
    found.status = SurfaceStatus::Undetermined;
    found.spacing_m = unknown(pattern.doubt);
    return;
  }
  if (is_of_the_code(profile, *pattern.spacing)) {
    found.status = SurfaceStatus::Undetermined;
    found.spacing_m =
        unknown("the repetition has the length of the blocks of JPEG compression; save the image as PNG or TIFF");
    return;
  }
  found.status = pattern.variation < thresholds::kIrregular || pattern.is_from_comb ? SurfaceStatus::Periodic
                                                                                    : SurfaceStatus::Irregular;
  found.method = pattern.is_from_comb ? SurfaceMethod::Comb : SurfaceMethod::Ridges;
  found.spacing_m = estimate(*pattern.spacing, profile.pitch_m);
  add_ridges(profile, pattern, found);
  if (patterns.size() > 1) found.fine_spacing_m = estimate(*patterns.back().spacing, profile.pitch_m);
}

void warn(Surface& found) {
  if (!found.spacing_m.value) return;
  found.warnings.push_back(
      {"origin_not_known",
       "a pattern alone does not show its origin: marks of turning, milling or grinding are periodic as well; they "
       "have the same spacing outside the track, whereas the spacing of stick-slip increases with sliding speed"});
  if (found.rsm_m && std::abs(*found.rsm_m / *found.spacing_m.value - 1.0) > thresholds::kNotableChange) {
    found.warnings.push_back({"rsm_differs",
                              "RSm differs from the spacing by more than a fifth: it counts roughness and "
                              "waves as well as ridges"});
  }
  const auto& begin = found.begin_spacing_m;
  const auto& end = found.end_spacing_m;
  if (begin.value && end.value &&
      std::abs(*begin.value - *end.value) >
          thresholds::kClearSigmas * std::hypot(*begin.standard_error, *end.standard_error)) {
    found.warnings.push_back({"spacing_drifts", "the spacing changes along the track: its mean is reported"});
  }
}

}  // namespace

Result<Surface> measure_surface(const Profile& profile) {
  if (auto error = refusal(profile)) return *error;
  const std::vector<double> heights = surface::without_form(without_holes(profile.height));
  const std::vector<Pattern> patterns = surface::find_patterns(heights);
  Surface found;
  if (!patterns.empty() && patterns.front().comb_spacing > 0.0) {
    const double count = static_cast<double>(heights.size()) / patterns.front().comb_spacing;
    if (count < static_cast<double>(thresholds::kFewestRidges)) return too_few_ridges(profile, count);
  }
  conclude(profile, patterns, found);
  const double length_m = profile.pitch_m * static_cast<double>(heights.size());
  add_rsm(profile, heights, found.spacing_m.value.value_or(length_m / 20.0), found);
  const auto holes = std::ranges::count_if(profile.height, [](double h) { return !std::isfinite(h); });
  if (holes > 0) {
    found.warnings.push_back(
        {"holes_bridged", fmt::format("{} points that were not measured were interpolated linearly", holes)});
  }
  warn(found);
  return found;
}

}  // namespace slipfit
