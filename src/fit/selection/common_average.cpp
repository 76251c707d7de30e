#include "fit/selection/common_average.hpp"

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

bool shows_rounding(const DampedFit& fit, const Recording& recording) {
  return !fit.average && fit.rounding && is_rounded(fit, *fit.rounding, recording.sample_interval_s());
}

}  // namespace

OwnFits fit_each(std::span<const SweepRecording> recordings, const HeldParameters& held) {
  OwnFits own;
  std::vector<FittedAverage> averages;
  std::size_t stated = 0;
  std::size_t fitted = 0;
  std::size_t rounded = 0;
  for (const SweepRecording& sweep : recordings) {
    std::optional<DampedFit>& fit = own.fits.emplace_back();
    if (sweep.role != SweepRole::Cycles) continue;
    fit = fit_as_sensed(sweep.recording, sweep.quality, sweep.segmentation, held);
    if (!fit) continue;
    ++fitted;
    if (sweep.recording.conditions().sensor_average_s) ++stated;
    if (fit->average) averages.push_back(*fit->average);
    if (shows_rounding(*fit, sweep.recording)) ++rounded;
  }
  const std::size_t open = fitted - stated;
  if (2 * averages.size() >= open && !averages.empty()) own.average = mean_of(averages);
  own.rounded = !own.average && 2 * (averages.size() + rounded) >= open && averages.size() + rounded > 0;
  if (!own.average) return own;
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
