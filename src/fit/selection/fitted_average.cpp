#include "fit/selection/fitted_average.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "core/fit_thresholds.hpp"
#include "core/thresholds.hpp"
#include "fit/inference/smoothing.hpp"
#include "fit/problem/solve.hpp"
#include "fit/selection/damped_fit.hpp"
#include "fit/selection/finish.hpp"
#include "fit/selection/kernel_search.hpp"
#include "fit/selection/reloading_fit.hpp"
#include "fit/selection/tiers.hpp"

namespace slipfit::fit {
namespace {

constexpr std::size_t kSearchCycles = 10;   // enough to begin with
constexpr std::size_t kCompareCycles = 40;  // enough to tell two kernels apart
constexpr double kLongTail = 3.0;           // variance of a tail that rounds as much as an average of variance 1
constexpr double kSameVariance = 0.01;      // in ln sigma^2
constexpr int kAveragedIterations = 30;     // a fit that explains the slips settles in fewer
constexpr double kForgottenLags = 8.0;      // e^-8
constexpr double kFewRest = 0.95 * thresholds::kRestickShare;  // of 64 slips a standard error below it

/// Where the search for W begins; empty without a sign of averaging. The sum of squares may have two minima, one of
/// much averaging, where the time of the fall is W's, and one of little with slips that are too slow.
std::vector<double> guesses_s(const Recording& recording, const DampedFit& plain) {
  const BlockFit& blocks = plain.blocks;
  const double of_fall_s = 0.7 * blocks.scales().half_period_s;
  const std::optional<Smoothing>& seen = plain.rounding;
  if (!seen || !seen->exceeds_step(recording.sample_interval_s())) return {};
  if (plain.refused_damping) return {of_fall_s};
  return {std::sqrt(12.0 * seen->variance_s2), of_fall_s};
}

/// The slips that are left behind W are those of the model.
bool follows_slips(const DampedFit& fit) {
  return !fit.misfit && !fit.refused_damping && resting_share(fit.blocks) >= thresholds::kRestickShare;
}

/// A fit of all cycles with an average in it, and what is left to smooth.
struct Trial {
  DampedFit fit;
  Smoothing beyond;
  double variance_s2 = 0.0;

  /// In standard errors.
  [[nodiscard]] double off() const { return std::abs(beyond.variance_s2) / beyond.standard_error_s2; }
};

/// Fits of all cycles with an average of about the given variance.
class Trials {
 public:
  Trials(const Recording& recording, const Quality& quality, const Segmentation& segmentation,
         const HeldParameters& held, const DampedFit& plain)
      : recording_(recording), quality_(quality), segmentation_(segmentation), held_(held), plain_(plain) {}

  /// Newton's steps in sigma^2, the nearest of them.
  [[nodiscard]] std::optional<Trial> fit(double variance_s2, const Globals& near) const {
    constexpr int kMostFits = 3;
    std::optional<Trial> best;
    std::optional<DampedFit> fit = draft_damped(with_average(recording_, variance_s2), quality_, segmentation_, held_,
                                                {near, plain_.excluded, reloading(std::sqrt(12.0 * variance_s2)),
                                                 plain_.blocks.level().per_cycle, kFewRest, kAveragedIterations});
    for (int fits = 1; fit; ++fits) {
      const auto beyond = estimate_smoothing(fit->blocks, fit->held, recording_.sample_interval_s());
      if (!beyond) break;
      Trial trial{*std::move(fit), *beyond, variance_s2};
      if (!best || trial.off() < best->off()) best = std::move(trial);
      const bool is_hopeless = !follows_slips(best->fit) || best->fit.uncertainty.noise > plain_.uncertainty.noise;
      if (fits == kMostFits || is_hopeless || best->off() < thresholds::kSettledAverage) break;
      variance_s2 += beyond->variance_s2;
      if (!(variance_s2 > 0.0)) break;
      fit = beside(best->fit, variance_s2);
    }
    return best;
  }

 private:
  /// Of the fit without an average, as one of this time shows it.
  [[nodiscard]] std::shared_ptr<const RiseAfterSlip> reloading(double average_s) const {
    if (!plain_.blocks.level().reloading) return nullptr;
    RiseAfterSlip reloading = *plain_.blocks.level().reloading;
    reloading.average_s = average_s;
    return std::make_shared<const RiseAfterSlip>(std::move(reloading));
  }

  /// The same cycles and samples with another average.
  [[nodiscard]] std::optional<DampedFit> beside(const DampedFit& other, double variance_s2) const {
    Scales scales = other.blocks.scales();
    scales.sensor_average_s = std::sqrt(12.0 * variance_s2);
    BlockFit blocks(other.blocks.set(), scales);
    blocks.parameters = other.blocks.parameters;
    if (!std::isfinite(solve(blocks, {other.held, false, true}))) return std::nullopt;
    return with_uncertainty({std::move(blocks), false, other.held, {}, other.half_width_s, other.excluded, {}, {}},
                            tolerated_misfit(quality_));
  }

  const Recording& recording_;
  const Quality& quality_;
  const Segmentation& segmentation_;
  const HeldParameters& held_;
  const DampedFit& plain_;  // without an average
};

/// Slips and W can be told apart.
bool tells_slips(const DampedFit& fit) {
  const double damping_error = std::sqrt(std::max(0.0, fit.uncertainty.covariance(kDamping, kDamping)));
  return damping_error < thresholds::kTellingDamping &&
         fit.average->seconds > thresholds::kSureTerm * fit.average->standard_error_s &&
         fit.average->seconds < median_stick_s(fit.blocks);
}

/// The average that explains some of the samples of some cycles best; empty where a sensor of first order is not ten
/// times less likely. A long tail rounds the slip less than its variance says: the search for it begins on both sides.
/// `plain` tells how far samples are independent.
std::optional<KernelSearch::Least> best_average(const std::vector<double>& variances_s2, const KernelSearch& search,
                                                const DampedFit& plain) {
  KernelSearch::Least best;
  for (const double variance_s2 : variances_s2) {
    KernelSearch::Least least = search.least_squares(Kernel::MovingAverage, variance_s2);
    least.variance_s2 = variance_s2;
    if (least.sum < best.sum) best = least;
  }
  const double independent = search.residuals() * effective_samples(plain) / plain.uncertainty.samples;
  for (const double tail : {1.0, kLongTail}) {
    const double lag = search.least_squares(Kernel::FirstOrder, tail * best.variance_s2).sum;
    if (!(independent * std::log(lag / best.sum) > thresholds::kEvidence)) return std::nullopt;
  }
  return best;
}

/// With what W is not known by in the covariance.
DampedFit with_average_error(Trial trial) {
  const double error_s2 = std::hypot(trial.beyond.standard_error_s2, trial.beyond.variance_s2,
                                     thresholds::kKernelShape * trial.variance_s2);
  const double average_s = std::sqrt(12.0 * trial.variance_s2);
  trial.fit.average = FittedAverage{average_s, 6.0 * error_s2 / average_s};
  trial.fit.uncertainty.covariance +=
      error_s2 * error_s2 * trial.beyond.move_per_s2 * trial.beyond.move_per_s2.transpose();
  return std::move(trial.fit);
}

}  // namespace

Recording with_average(const Recording& recording, double variance_s2) {
  Conditions conditions = recording.conditions();
  conditions.sensor_average_s = std::sqrt(12.0 * variance_s2);
  const auto time_s = recording.time_s();
  const auto force = recording.force();
  return Recording::create({time_s.begin(), time_s.end()}, {force.begin(), force.end()}, conditions,
                           recording.provenance())
      .value();
}

std::optional<DampedFit> fit_average(const Recording& recording, const Quality& quality,
                                     const Segmentation& segmentation, const HeldParameters& held,
                                     const DampedFit& plain) {
  const std::vector<double> guesses = guesses_s(recording, plain);
  if (guesses.empty()) return std::nullopt;
  const double width_s = 2.0 * plain.blocks.scales().half_period_s;
  const KernelSearch search(recording, segmentation, held, plain, width_s, kSearchCycles);
  std::vector<double> variances_s2;
  for (const double guess_s : guesses) {
    const std::optional<double> average_s = search.converge(guess_s);
    if (!average_s) continue;
    const double variance_s2 = *average_s * *average_s / 12.0;
    const auto is_same = [&](double other_s2) { return std::abs(std::log(variance_s2 / other_s2)) < kSameVariance; };
    if (std::ranges::none_of(variances_s2, is_same)) variances_s2.push_back(variance_s2);
  }
  if (variances_s2.empty()) return std::nullopt;
  const double longest_lag_s = std::sqrt(kLongTail * *std::max_element(variances_s2.begin(), variances_s2.end()));
  const KernelSearch comparison(recording, segmentation, held, plain, width_s + kForgottenLags * longest_lag_s,
                                kCompareCycles);
  const std::optional<KernelSearch::Least> best = best_average(variances_s2, comparison, plain);
  if (!best || best->resting < thresholds::kRestickShare) return std::nullopt;
  std::optional<Trial> trial =
      Trials(recording, quality, segmentation, held, plain).fit(best->variance_s2, best->globals);
  const bool is_better = trial && follows_slips(trial->fit) && gain_of(trial->fit, plain) > thresholds::kTierPrice;
  if (!is_better) return std::nullopt;
  std::optional<DampedFit> finished =
      finish_fit(with_average(recording, trial->variance_s2), quality, segmentation, std::move(trial->fit));
  if (!finished) return std::nullopt;
  trial->fit = *std::move(finished);
  DampedFit fit = with_average_error(*std::move(trial));
  return tells_slips(fit) ? std::optional(std::move(fit)) : std::nullopt;
}

std::optional<DampedFit> fit_as_sensed(const Recording& recording, const Quality& quality,
                                       const Segmentation& segmentation, const HeldParameters& held, DampedFit plain) {
  if (!recording.conditions().sensor_average_s) {
    plain.rounding = estimate_smoothing(plain.blocks, plain.held, recording.sample_interval_s());
    if (auto averaged = fit_average(recording, quality, segmentation, held, plain)) return averaged;
  }
  return finish_fit(recording, quality, segmentation, std::move(plain));
}

bool repeats_rounding(const DampedFit& fit) {
  return fit.uncertainty.from_refits && !fit.misfit;
}

}  // namespace slipfit::fit
