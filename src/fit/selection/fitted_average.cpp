#include "fit/selection/fitted_average.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/fit_thresholds.hpp"
#include "fit/inference/smoothing.hpp"
#include "fit/selection/damped_fit.hpp"
#include "fit/selection/tiers.hpp"
#include "signal/robust.hpp"

namespace slipfit::fit {
namespace {

Recording averaged(const Recording& recording, double average_s) {
  Conditions conditions = recording.conditions();
  conditions.sensor_average_s = average_s;
  const auto time_s = recording.time_s();
  const auto force = recording.force();
  return Recording::create({time_s.begin(), time_s.end()}, {force.begin(), force.end()}, conditions,
                           recording.provenance())
      .value();
}

/// Median time from the end of one slip to the onset of the next.
double stick_s(const BlockFit& blocks) {
  std::vector<double> sticks_s;
  for (std::size_t i = 0; i + 1 < blocks.size(); ++i) {
    if (!blocks.data(i).continuous_with_next) continue;
    const CycleState state = blocks.state(i);
    sticks_s.push_back(blocks.state(i + 1).onset_s - state.onset_s - state.slip_s());
  }
  return signal::median(std::move(sticks_s));
}

/// Where the search for W begins; empty without a sign of averaging. The sum of squares may have two minima, one of
/// much averaging, where the time of the fall is W's, and one of little with slips that are too slow.
std::vector<double> guesses_s(const Recording& recording, const DampedFit& plain) {
  const BlockFit& blocks = plain.blocks;
  const double step_s = recording.sample_interval_s();
  const double of_fall_s = 0.7 * blocks.scales().half_period_s;
  if (plain.refused_damping) return {of_fall_s};
  const std::optional<Smoothing> seen = estimate_smoothing(blocks, plain.held, step_s);
  if (!seen) return {};
  const double surely_s2 = seen->variance_s2 - thresholds::kRoundedSigmas * seen->standard_error_s2;
  if (!(surely_s2 > step_s * step_s / 12.0)) return {};
  return {std::sqrt(12.0 * seen->variance_s2), of_fall_s};
}

/// A fit with this W in it, and the W that it asks for.
struct Trial {
  DampedFit fit;
  Smoothing beyond;  ///< what is left to average
};

/// Newton's steps in W^2, none by more than a factor of 4.
std::optional<Trial> converge(const Recording& recording, const Quality& quality, const Segmentation& segmentation,
                              const HeldParameters& held, double average_s) {
  constexpr int kMostSteps = 12;
  const double step_s = recording.sample_interval_s();
  for (int step = 0; step < kMostSteps; ++step) {
    std::optional<DampedFit> fit = fit_damped(averaged(recording, average_s), quality, segmentation, held);
    if (!fit) return std::nullopt;
    const std::optional<Smoothing> beyond = estimate_smoothing(fit->blocks, fit->held, step_s);
    if (!beyond) return std::nullopt;
    fit->average = FittedAverage{average_s, 6.0 * beyond->standard_error_s2 / average_s};
    if (std::abs(beyond->variance_s2) < thresholds::kSettledAverage * beyond->standard_error_s2) {
      return Trial{std::move(*fit), *beyond};
    }
    const double square = average_s * average_s;
    average_s = std::sqrt(std::clamp(square + 12.0 * beyond->variance_s2, 0.25 * square, 4.0 * square));
    if (average_s < step_s || average_s > stick_s(fit->blocks)) return std::nullopt;
  }
  return std::nullopt;
}

double misfit_of(const DampedFit& fit) {
  return fit.misfit ? std::abs(fit.misfit->size) : 0.0;
}

/// The better fit is worth the parameter and misses less of the mean shape of the slips.
bool explains(const DampedFit& with, const DampedFit& without) {
  if (with.refused_damping) return false;
  const double gain = 2.0 * effective_samples(without) * std::log(without.uncertainty.noise / with.uncertainty.noise);
  const bool fits_shape = misfit_of(with) <= thresholds::kExplainedMisfit * misfit_of(without);
  const bool is_sure = with.average->seconds > thresholds::kSureTerm * with.average->standard_error_s;
  return gain > thresholds::kTierPrice && fits_shape && is_sure;
}

}  // namespace

std::optional<DampedFit> fit_average(const Recording& recording, const Quality& quality,
                                     const Segmentation& segmentation, const HeldParameters& held,
                                     const DampedFit& plain) {
  std::optional<Trial> best;
  for (const double guess_s : guesses_s(recording, plain)) {
    std::optional<Trial> trial = converge(recording, quality, segmentation, held, guess_s);
    if (!trial || (best && best->fit.uncertainty.noise <= trial->fit.uncertainty.noise)) continue;
    best = std::move(trial);
  }
  if (!best || !explains(best->fit, plain)) return std::nullopt;
  const Smoothing& beyond = best->beyond;
  best->fit.uncertainty.covariance +=
      beyond.standard_error_s2 * beyond.standard_error_s2 * beyond.move_per_s2 * beyond.move_per_s2.transpose();
  return std::move(best->fit);
}

}  // namespace slipfit::fit
