#include "surface/ridges.hpp"

#include <algorithm>
#include <cmath>

#include "core/quantile.hpp"
#include "core/surface_thresholds.hpp"
#include "signal/turning_points.hpp"
#include "surface/filter.hpp"

namespace slipfit::surface {
namespace {

/// The profile between two cut-offs, on blocks a sixteenth of the shorter.
struct Band {
  double block = 1.0;
  std::vector<double> values;

  [[nodiscard]] double place(double index) const { return (index + 0.5) * block - 0.5; }
};

Band band_of(std::span<const double> heights, double short_cutoff, double long_cutoff) {
  const auto block = std::max<std::size_t>(1, static_cast<std::size_t>(short_cutoff / 16.0));
  Band band{static_cast<double>(block), block_means(heights, block)};
  band.values = gaussian_mean(band.values, std::max(1.0, short_cutoff / band.block));
  const std::vector<double> waves = waviness(band.values, long_cutoff / band.block);
  for (std::size_t i = 0; i < waves.size(); ++i) band.values[i] -= waves[i];
  return band;
}

/// Half of the range that holds the middle four fifths of the values, as a swing: a scratch does not count.
double usual_swing(const std::vector<double>& values) {
  return quantile_of(values, 0.9) - quantile_of(values, 0.1);
}

/// Returns the position at which the values cross the midpoint of two turning points.
double crossing(const std::vector<double>& values, std::size_t from, std::size_t to) {
  const double middle = 0.5 * (values[from] + values[to]);
  const bool falls = values[from] > values[to];
  std::size_t i = from;
  while (i + 1 < to && (values[i + 1] > middle) == falls) ++i;
  const double step = values[i + 1] - values[i];
  return static_cast<double>(i) + (step == 0.0 ? 0.5 : std::clamp((middle - values[i]) / step, 0.0, 1.0));
}

/// Returns the maximum of the parabola through three values.
double top(const std::vector<double>& values, std::size_t i) {
  if (i == 0 || i + 1 >= values.size()) return static_cast<double>(i);
  const double bend = values[i - 1] - 2.0 * values[i] + values[i + 1];
  if (bend == 0.0) return static_cast<double>(i);
  return static_cast<double>(i) + std::clamp(0.5 * (values[i - 1] - values[i + 1]) / bend, -0.5, 0.5);
}

}  // namespace

Ridges find_ridges(std::span<const double> heights, double smoothed_over, double waves_above) {
  Ridges ridges;
  ridges.smoothed_over = smoothed_over;
  ridges.waves_above = waves_above;
  const Band band = band_of(heights, smoothed_over, waves_above);
  if (band.values.size() < 8) return ridges;
  signal::TurningPoints turning(thresholds::kRidgeSwing * usual_swing(band.values));
  for (std::size_t i = 0; i < band.values.size(); ++i) turning.add(i, band.values[i]);
  const auto& falls = turning.falls();
  for (std::size_t j = 0; j < falls.size(); ++j) {
    if (falls[j].peak == 0 || falls[j].trough + 1 == band.values.size()) continue;
    ridges.peaks.push_back(band.place(top(band.values, falls[j].peak)));
    ridges.valleys.push_back(band.place(top(band.values, falls[j].trough)));
    ridges.falls.push_back(band.place(crossing(band.values, falls[j].peak, falls[j].trough)));
    ridges.heights.push_back(band.values[falls[j].peak] - band.values[falls[j].trough]);
    if (j + 1 < falls.size()) {
      ridges.rises.push_back(band.place(crossing(band.values, falls[j].trough, falls[j + 1].peak)));
    }
  }
  return ridges;
}

std::vector<double> distances(std::span<const double> places) {
  std::vector<double> result;
  for (std::size_t i = 1; i < places.size(); ++i) result.push_back(places[i] - places[i - 1]);
  return result;
}

double variation(std::span<const double> values) {
  const MeanAndSpread found = describe(values);
  return values.size() < 2 ? 0.0 : found.sd / std::abs(found.mean);
}

}  // namespace slipfit::surface
