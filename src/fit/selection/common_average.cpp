#include "fit/selection/common_average.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <cstddef>

#include "core/fit_thresholds.hpp"
#include "fit/selection/damped_fit.hpp"
#include "fit/selection/fitted_average.hpp"

namespace slipfit::fit {
namespace {

/// Mean by their errors; empty where they differ by more than these.
std::optional<FittedAverage> mean_of(const std::vector<FittedAverage>& averages) {
  double weights = 0.0;
  double sum = 0.0;
  for (const FittedAverage& one : averages) {
    const double weight = 1.0 / (one.standard_error_s * one.standard_error_s);
    weights += weight;
    sum += weight * one.seconds;
  }
  const double mean_s = sum / weights;
  double square = 0.0;
  for (const FittedAverage& one : averages) square += std::pow((one.seconds - mean_s) / one.standard_error_s, 2);
  if (averages.size() > 1) {
    const boost::math::chi_squared_distribution<double> by_chance(static_cast<double>(averages.size()) - 1.0);
    if (boost::math::cdf(boost::math::complement(by_chance, square)) < thresholds::kShareChance) return std::nullopt;
  }
  // Most of each error is the unknown shape of the kernel, which all share: the mean is known no better than one.
  double error_s = averages.front().standard_error_s;
  for (const FittedAverage& one : averages) error_s = std::min(error_s, one.standard_error_s);
  return FittedAverage{mean_s, error_s};
}

/// What one recording shows of averaging that nobody stated; empty where it cannot tell.
std::optional<Smoothing> rounding_of(const SweepRecording& sweep, const DampedFit& fit) {
  if (sweep.recording.conditions().sensor_average_s) return std::nullopt;
  if (fit.average) {
    const double average_s = fit.average->seconds;
    return Smoothing{average_s * average_s / 12.0, average_s * fit.average->standard_error_s / 6.0};
  }
  return repeats_rounding(fit) ? std::nullopt : fit.rounding;
}

/// All recordings of a machine average over the same time: what each alone cannot tell they may tell together.
std::optional<double> common_rounding_s2(std::span<const SweepRecording> recordings, const OwnFits& own) {
  double weights = 0.0;
  double sum = 0.0;
  double longest_step_s = 0.0;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const std::optional<Smoothing> seen = own.fits[i] ? rounding_of(recordings[i], *own.fits[i]) : std::nullopt;
    if (!seen || !(seen->standard_error_s2 > 0.0)) continue;
    const double weight = std::pow(seen->standard_error_s2, -2);
    weights += weight;
    sum += weight * seen->variance_s2;
    longest_step_s = std::max(longest_step_s, recordings[i].recording.sample_interval_s());
  }
  if (!(weights > 0.0)) return std::nullopt;
  const Smoothing together{sum / weights, 1.0 / std::sqrt(weights)};
  return together.exceeds_step(longest_step_s) ? std::optional(together.largest_variance_s2()) : std::nullopt;
}

}  // namespace

OwnFits fit_each(std::span<const SweepRecording> recordings, const HeldParameters& held) {
  OwnFits own;
  std::vector<FittedAverage> averages;
  std::size_t stated = 0;
  std::size_t fitted = 0;
  for (const SweepRecording& sweep : recordings) {
    std::optional<DampedFit>& fit = own.fits.emplace_back();
    if (sweep.role != SweepRole::Cycles) continue;
    fit = fit_as_sensed(sweep.recording, sweep.quality, sweep.segmentation, held);
    if (!fit) continue;
    ++fitted;
    if (sweep.recording.conditions().sensor_average_s) ++stated;
    if (fit->average) averages.push_back(*fit->average);
  }
  const std::size_t open = fitted - stated;
  if (2 * averages.size() >= open && !averages.empty()) own.average = mean_of(averages);
  if (!own.average) {
    own.rounding_s2 = common_rounding_s2(recordings, own);
    return own;
  }
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const SweepRecording& sweep = recordings[i];
    if (!own.fits[i] || sweep.recording.conditions().sensor_average_s) continue;
    const Recording averaged = with_average(sweep.recording, own.average->seconds * own.average->seconds / 12.0);
    own.fits[i] = fit_damped(averaged, sweep.quality, sweep.segmentation, held);
    if (own.fits[i]) own.fits[i]->average = own.average;
  }
  return own;
}

}  // namespace slipfit::fit
