#include "fit/selection/fitted_average.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/fit_thresholds.hpp"
#include "core/thresholds.hpp"
#include "fit/cycle/start.hpp"
#include "fit/inference/smoothing.hpp"
#include "fit/problem/solve.hpp"
#include "fit/selection/carried_fit.hpp"
#include "fit/selection/damped_fit.hpp"
#include "fit/selection/finish.hpp"
#include "fit/selection/kernel_search.hpp"
#include "fit/selection/reloading_fit.hpp"
#include "fit/selection/tiers.hpp"

namespace slipfit::fit {
namespace {

constexpr std::size_t kSearchCycles = 10;   // enough to begin with
constexpr std::size_t kCompareCycles = 40;  // enough to tell two kernels apart
constexpr double kSame = 0.05;              // of the variance: Newton's steps have led to one minimum from two sides
constexpr double kLongTail = 3.0;           // variance of a tail that rounds as much as an average of variance 1
constexpr int kAveragedIterations = 30;     // a fit that explains the slips settles in fewer
constexpr double kForgottenLags = 8.0;      // e^-8
constexpr double kFewRest = 0.95 * thresholds::kRestickShare;  // of 64 slips a standard error below it

/// Rounded slips, slips that are not shaped like the model's, or slips without damping: an average that lasts longer
/// than the slip takes it away.
bool may_be_averaged(const Recording& recording, const DampedFit& plain) {
  const std::optional<Smoothing>& seen = plain.rounding;
  const double zeta = plain.blocks.parameters.globals[kDamping];
  const bool is_damped = zeta > thresholds::kSureTerm * damping_error(plain);
  return plain.misfit || plain.refused_damping || !is_damped ||
         (seen && seen->exceeds_step(recording.sample_interval_s()));
}

/// The slips that are left behind W are those of the model, and longer than a step of the clock.
bool follows_slips(const DampedFit& fit, double sample_interval_s) {
  const double negative = -thresholds::kNegativeSigmas * damping_error(fit);
  return !fit.misfit && !fit.refused_damping && fit.blocks.parameters.globals[kDamping] > negative &&
         resting_share(fit.blocks) >= thresholds::kRestickShare && median_slip_s(fit.blocks) > sample_interval_s;
}

/// A fit of all cycles with an average in it, and what is left to smooth.
struct Trial {
  DampedFit fit;
  Smoothing beyond;
  double variance_s2 = 0.0;

  /// In standard errors.
  [[nodiscard]] double off() const { return std::abs(beyond.variance_s2) / beyond.standard_error_s2; }
  [[nodiscard]] bool is_settled() const { return off() < thresholds::kSettledAverage; }
};

/// Mean square that a fit leaves in those slips that `some` cycles of the recording hold.
double mean_square_in(const BlockFit& some, const BlockFit& fit) {
  double sum = 0.0;
  std::size_t residuals = 0;
  std::size_t next = 0;
  for (std::size_t i = 0; i < fit.size() && next < some.size(); ++i) {
    while (next < some.size() && some.data(next).slip < fit.data(i).slip) ++next;
    if (next == some.size() || some.data(next).slip != fit.data(i).slip) continue;
    sum += fit.cycle_sum_of_squares(i);
    residuals += fit.data(i).residuals();
  }
  return sum / static_cast<double>(residuals);
}

/// Fits of all cycles with an average of about the given variance.
class Trials {
 public:
  Trials(const Recording& recording, const Quality& quality, const Segmentation& segmentation,
         const HeldParameters& held, const DampedFit& plain)
      : recording_(recording), quality_(quality), segmentation_(segmentation), held_(held), plain_(plain) {}

  /// Newton's steps in sigma^2, the nearest of them. `other`: a fit with another average, whose cycles and samples will
  /// do.
  [[nodiscard]] std::optional<Trial> fit(double variance_s2, const Globals& near, const DampedFit* other) const {
    const int most_fits = plain_.blocks.level().reloading ? 6 : 3;
    std::optional<Trial> best;
    std::optional<DampedFit> fit = other != nullptr ? beside(*other, variance_s2, &near) : drafted(variance_s2, near);
    for (int fits = 1; fit; ++fits) {
      const auto beyond = estimate_smoothing(fit->blocks, fit->held, recording_.sample_interval_s());
      if (!beyond) break;
      Trial trial{*std::move(fit), *beyond, variance_s2};
      if (!best || trial.off() < best->off()) best = std::move(trial);
      const bool is_worse = !follows_slips(best->fit, recording_.sample_interval_s()) ||
                            best->fit.uncertainty.noise > plain_.uncertainty.noise;
      if (fits == most_fits || is_worse || best->is_settled()) break;
      variance_s2 += beyond->variance_s2;
      if (!(variance_s2 > 0.0)) break;
      fit = beside(best->fit, variance_s2, nullptr);
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

  [[nodiscard]] std::optional<DampedFit> drafted(double variance_s2, const Globals& near) const {
    std::optional<DampedFit> fit =
        draft_damped(with_average(recording_, variance_s2), quality_, segmentation_, held_,
                     {near, plain_.excluded, reloading(std::sqrt(12.0 * variance_s2)), plain_.blocks.level().per_cycle,
                      kAveragedIterations, [this](const BlockFit& some) { return is_hopeless(some); }, true});
    return settle_rise(recording_.sample_interval_s(), quality_, std::move(fit));
  }

  /// A fit of some cycles whose slips do not come to rest, or that explains them less well than the fit without
  /// average.
  [[nodiscard]] bool is_hopeless(const BlockFit& some) const {
    return resting_share(some) < kFewRest || mean_square_in(some, some) > mean_square_in(some, plain_.blocks);
  }

  /// The same cycles and samples with another average, and the rise after the slips that it shows. From the other's
  /// solution on, or from `start`.
  [[nodiscard]] std::optional<DampedFit> beside(const DampedFit& other, double variance_s2,
                                                const Globals* start) const {
    BlockFit blocks = averaged_by(other.blocks, variance_s2);
    if (start != nullptr) set_start(blocks, segmentation_, *start);
    if (!std::isfinite(solve(blocks, {other.held, false, true}))) return std::nullopt;
    std::optional<DampedFit> fit =
        with_uncertainty({std::move(blocks), false, other.held, {}, other.half_width_s, other.excluded, {}, {}},
                         tolerated_misfit(quality_));
    return settle_rise(recording_.sample_interval_s(), quality_, std::move(fit));
  }

  const Recording& recording_;
  const Quality& quality_;
  const Segmentation& segmentation_;
  const HeldParameters& held_;
  const DampedFit& plain_;  // without an average
};

/// Slips and W can be told apart.
bool tells_slips(const DampedFit& fit) {
  return damping_error(fit) < thresholds::kTellingDamping &&
         fit.average->seconds > thresholds::kSureTerm * fit.average->standard_error_s;
}

/// Logarithm of how much more likely `better` is on these cycles. `plain` tells how far samples are independent.
double evidence(const KernelSearch::Least& better, const KernelSearch::Least& other, const KernelSearch& search,
                const DampedFit& plain) {
  const double independent = search.residuals() * effective_samples(plain) / plain.uncertainty.samples;
  return independent * std::log(other.sum / better.sum);
}

/// Averages that explain some of the samples of some cycles, the best first and those that it does not rule out; empty
/// where a sensor of first order is not ten times less likely. A long tail rounds the slip less than its variance says:
/// the search for it begins on both sides.
std::vector<KernelSearch::Least> best_averages(const std::vector<KernelSearch::Least>& minima,
                                               const KernelSearch& search, const DampedFit& plain) {
  std::vector<KernelSearch::Least> averages;
  for (const KernelSearch::Least& minimum : minima) {
    const KernelSearch::Least least = search.refined(minimum);
    const bool is_new = std::none_of(averages.begin(), averages.end(), [&](const KernelSearch::Least& other) {
      return std::abs(other.variance_s2 - least.variance_s2) < kSame * least.variance_s2;
    });
    if (is_new && least.resting >= thresholds::kRestickShare) averages.push_back(least);
  }
  std::sort(averages.begin(), averages.end(), [](const auto& a, const auto& b) { return a.sum < b.sum; });
  if (averages.empty()) return {};
  const KernelSearch::Least best = averages.front();
  std::erase_if(averages,
                [&](const auto& other) { return evidence(best, other, search, plain) > thresholds::kTierPrice; });
  for (const double tail : {1.0, kLongTail}) {
    const KernelSearch::Least lag = search.least_squares(Kernel::FirstOrder, tail * best.variance_s2);
    if (!(evidence(best, lag, search, plain) > thresholds::kEvidence)) return {};
  }
  return averages;
}

/// The fit of all cycles that explains them best, and another average that does so as well.
struct Found {
  std::optional<Trial> trial;
  std::optional<double> other_s;
};
Found best_trial(const Trials& trials, const DampedFit& plain, const std::vector<KernelSearch::Least>& starts,
                 double sample_interval_s) {
  Found found;
  std::optional<Trial>& trial = found.trial;
  for (const KernelSearch::Least& start : starts) {
    std::optional<Trial> next = trials.fit(start.variance_s2, start.globals, trial ? &trial->fit : nullptr);
    const bool is_better =
        next && follows_slips(next->fit, sample_interval_s) && gain_of(next->fit, plain) > thresholds::kTierPrice;
    if (!is_better) continue;
    if (!trial) {
      trial = std::move(next);
      continue;
    }
    const double gain = gain_of(next->fit, trial->fit);
    if (gain > 0.0) std::swap(trial, next);
    const double apart_s2 = std::abs(next->variance_s2 - trial->variance_s2);
    const bool is_another = apart_s2 > thresholds::kSureTerm * trial->beyond.standard_error_s2;
    if (is_another && std::abs(gain) < thresholds::kTierPrice) found.other_s = std::sqrt(12.0 * next->variance_s2);
  }
  return found;
}

/// Why w_n and zeta cannot be told beside an average; empty: they can.
std::string doubt_beside(const DampedFit& fit, std::optional<double> other_s) {
  if (other_s) {
    return fmt::format(
        "quick slips that are averaged over {:.3g} ms and slow ones that are averaged over {:.3g} ms explain the "
        "recording alike: state the average with --sensor-average, or the mass",
        1e3 * std::max(*other_s, fit.average->seconds), 1e3 * std::min(*other_s, fit.average->seconds));
  }
  if (tells_slips(fit)) return {};
  return "the slips and the average of the sensor behind which they are seen cannot be told apart: state the average "
         "with --sensor-average, or the mass";
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

DampedFit with_average_error(DampedFit fit, double variance_s2, const Smoothing& beyond) {
  const double error_s2 =
      std::hypot(beyond.standard_error_s2, beyond.variance_s2, thresholds::kKernelShape * variance_s2);
  const double average_s = std::sqrt(12.0 * variance_s2);
  fit.average = FittedAverage{average_s, 6.0 * error_s2 / average_s};
  fit.uncertainty.covariance += error_s2 * error_s2 * beyond.move_per_s2 * beyond.move_per_s2.transpose();
  return fit;
}

std::optional<DampedFit> fit_average(const Recording& recording, const Quality& quality,
                                     const Segmentation& segmentation, const HeldParameters& held,
                                     const DampedFit& plain) {
  if (!may_be_averaged(recording, plain)) return std::nullopt;
  const double width_s = 2.0 * plain.blocks.scales().half_period_s;
  // Half of what all cycles have to gain: a few of them may tell less.
  const double worth = 0.5 * thresholds::kTierPrice / effective_samples(plain);
  const std::vector<KernelSearch::Least> minima =
      KernelSearch(recording, segmentation, held, plain, width_s, kSearchCycles).minima(worth);
  if (minima.empty()) return std::nullopt;
  double longest_s2 = 0.0;
  for (const KernelSearch::Least& least : minima) longest_s2 = std::max(longest_s2, least.variance_s2);
  const double longest_lag_s = std::sqrt(kLongTail * longest_s2);
  const KernelSearch comparison(recording, segmentation, held, plain, width_s + kForgottenLags * longest_lag_s,
                                kCompareCycles);
  auto [trial, other_s] = best_trial(Trials(recording, quality, segmentation, held, plain), plain,
                                     best_averages(minima, comparison, plain), recording.sample_interval_s());
  if (!trial) return std::nullopt;
  std::optional<DampedFit> finished =
      finish_fit(with_average(recording, trial->variance_s2), quality, segmentation, std::move(trial->fit));
  if (!finished) return std::nullopt;
  trial->fit = *std::move(finished);
  DampedFit fit = with_average_error(std::move(trial->fit), trial->variance_s2, trial->beyond);
  if (!(fit.average->seconds < median_stick_s(fit.blocks))) return std::nullopt;
  fit.fall_doubt = doubt_beside(fit, other_s);
  if (other_s) {
    fit.average->standard_error_s = std::hypot(fit.average->standard_error_s, *other_s - fit.average->seconds);
  }
  return fit;
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
