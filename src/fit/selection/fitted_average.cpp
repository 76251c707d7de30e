#include "fit/selection/fitted_average.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/fit_thresholds.hpp"
#include "core/thresholds.hpp"
#include "fit/inference/sensor_time.hpp"
#include "fit/inference/smoothing.hpp"
#include "fit/selection/average_solver.hpp"
#include "fit/selection/carried_fit.hpp"
#include "fit/selection/finish.hpp"
#include "fit/selection/kernel_search.hpp"
#include "fit/selection/rival.hpp"
#include "fit/selection/tiers.hpp"

namespace slipfit::fit {
namespace {

constexpr std::size_t kSearchCycles = 10;   // enough to begin with
constexpr std::size_t kCompareCycles = 40;  // enough to tell two kernels apart
constexpr double kSame = 0.05;              // of the variance: Newton's steps have led to one minimum from two sides
constexpr double kLongTail = 3.0;           // variance of a tail that rounds as much as an average of variance 1
constexpr double kForgottenLags = 8.0;      // e^-8

/// Rounded slips, slips that are not shaped like the model's, or slips without damping: an average that lasts longer
/// than the slip takes it away. Falls within a step of the clock show nothing of it.
bool may_be_averaged(const FitInput& input, const DampedFit& plain) {
  const double step_s = input.recording.sample_interval_s();
  if (!(median_slip_s(plain.blocks) > step_s) || hides_shape(input.quality.noise_rms, plain)) return false;
  const std::optional<Smoothing>& seen = plain.rounding;
  const double zeta = plain.blocks.parameters.values(kDamping);
  const bool is_damped = zeta > thresholds::kSureTerm * damping_error(plain);
  return plain.misfit || plain.refused_damping || !is_damped || (seen && seen->exceeds_step(step_s));
}

/// Slips behind it that are damped look like longer ones that are not.
bool hides_damping(double average_s, double log_omega) {
  return std::exp(log_omega) * average_s > thresholds::kHidingAverage;
}
bool hides_damping(const KernelSearch::Least& least) {
  return hides_damping(std::sqrt(12.0 * least.variance_s2), least.parameters.values(kLogFrequency));
}

/// Slips and W can be told apart.
bool tells_slips(const DampedFit& fit) {
  return damping_error(fit) < thresholds::kTellingDamping && tells_average(*fit.average);
}

/// Logarithm of how much more likely `better` is on these cycles. `plain` tells how far samples are independent.
double evidence(const KernelSearch::Least& better, const KernelSearch::Least& other, const KernelSearch& search,
                const DampedFit& plain) {
  const double independent = search.residuals() * effective_samples(plain) / plain.uncertainty.samples;
  return independent * std::log(other.sum / better.sum);
}

/// Averages that explain some of the samples of some cycles, the best first and those that it does not rule out.
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
  return averages;
}

/// A sensor of first order is ten times less likely. A long tail rounds the slip less than its variance says: the
/// search for it begins on both sides.
bool rules_out_lag(const KernelSearch::Least& average, const KernelSearch& search, const DampedFit& plain) {
  return std::ranges::all_of(std::array{1.0, kLongTail}, [&](double tail) {
    const KernelSearch::Least lag = search.least_lag(average, tail * average.variance_s2);
    return evidence(average, lag, search, plain) > thresholds::kEvidence;
  });
}

/// The fit of all cycles that explains them best, and another average that does so as well.
struct Found {
  std::optional<DampedFit> trial;
  std::optional<DampedFit> other;
};
Found best_trial(const AverageSolver& solver, const DampedFit& plain, const std::vector<KernelSearch::Least>& starts,
                 double sample_interval_s, double least_gain) {
  Found found;
  std::optional<DampedFit>& trial = found.trial;
  for (const KernelSearch::Least& start : starts) {
    std::optional<DampedFit> next = solver.fit(start.variance_s2, start.parameters.values, trial ? &*trial : nullptr);
    const bool is_better = next && follows_slips(*next, sample_interval_s) && gain_of(*next, plain) > least_gain;
    if (!is_better) continue;
    if (!trial) {
      trial = std::move(next);
      continue;
    }
    const double gain = gain_of(*next, *trial);
    if (gain > 0.0) std::swap(trial, next);
    const double apart =
        std::abs(next->blocks.parameters.values(kSensorTime) - trial->blocks.parameters.values(kSensorTime));
    const bool is_another = apart > thresholds::kSureTerm * sensor_time_error(trial->uncertainty.covariance);
    if (is_another && std::abs(gain) < thresholds::kTierPrice) found.other = std::move(next);
  }
  return found;
}

/// Finished, with what the average is not known by.
std::optional<DampedFit> finish_averaged(const FitInput& input, DampedFit draft) {
  const Recording averaged = with_average(input.recording, draft.blocks.sensor().average_s);
  std::optional<DampedFit> fit =
      finish_fit({averaged, input.quality, input.segmentation, input.held}, std::move(draft));
  return fit ? std::optional(with_average_error(*std::move(fit))) : std::nullopt;
}

/// What an average of the instrument explains that a fit without does not.
struct AverageTrial {
  std::optional<DampedFit> fit{};    ///< empty: not taken
  std::optional<DampedFit> rival{};  ///< not taken, but not ruled out, though its w_n and zeta are others
};

/// The fit with one parameter more, the time W over which the instrument averages its samples (docs/model.md section
/// 7), where it is not stated and `plain`, the fit without, shows a sign of it. Its covariance holds that of W. Not
/// taken where W does not explain all that `plain` misses of the slips or a sensor of first order explains it as well.
/// Where W cannot be told from the slips behind it DampedFit::fall_doubt says so; where another W explains them as
/// well, intervals hold both fits.
AverageTrial try_average(const FitInput& input, const DampedFit& plain) {
  if (!may_be_averaged(input, plain)) return {};
  const double width_s = 2.0 * plain.blocks.scales().half_period_s;
  // Half of what all cycles have to gain: a few of them may tell less.
  const double worth = 0.5 * thresholds::kTierPrice / effective_samples(plain);
  const double shown = std::min(1.0, static_cast<double>(kSearchCycles) / static_cast<double>(plain.blocks.size()));
  const double doubtful = -2.0 * thresholds::kNotRuledOut / (shown * effective_samples(plain));  // of a few of them
  const std::optional<KernelSearch> search = KernelSearch::create(input, plain, width_s, kSearchCycles);
  if (!search) return {};
  std::vector<KernelSearch::Least> minima = search->minima(doubtful);
  std::erase_if(minima, [&](const KernelSearch::Least& least) { return least.gain < worth && !hides_damping(least); });
  if (minima.empty()) return {};
  double longest_s2 = 0.0;
  for (const KernelSearch::Least& least : minima) longest_s2 = std::max(longest_s2, least.variance_s2);
  const double longest_lag_s = std::sqrt(kLongTail * longest_s2);
  const std::optional<KernelSearch> comparison =
      KernelSearch::create(input, plain, width_s + kForgottenLags * longest_lag_s, kCompareCycles);
  const auto averages = comparison ? best_averages(minima, *comparison, plain) : std::vector<KernelSearch::Least>();
  if (averages.empty()) return {};
  auto [trial, other] = best_trial(AverageSolver(input, plain), plain, averages, input.recording.sample_interval_s(),
                                   -thresholds::kNotRuledOut);
  if (!trial) return {};
  const bool is_taken =
      gain_of(*trial, plain) > thresholds::kTierPrice && rules_out_lag(averages.front(), *comparison, plain);
  const double average_s = trial->blocks.sensor().average_s;
  if (!is_taken && !hides_damping(average_s, trial->blocks.parameters.values(kLogFrequency))) return {};
  std::optional<DampedFit> fit = finish_averaged(input, *std::move(trial));
  if (!fit || !(fit->average->seconds < median_stick_s(fit->blocks))) return {};
  if (!is_taken) return {std::nullopt, std::move(fit)};
  if (!tells_slips(*fit)) {
    fit->fall_doubt = "the slips and the average of the sensor behind which they are seen cannot be told apart";
  }
  if (other) other = finish_averaged(input, *std::move(other));
  if (other) fit = beside_rival(*std::move(fit), *other);
  return {std::move(fit), std::nullopt};
}

}  // namespace

bool tells_average(const FittedAverage& average) {
  return average.seconds > 2.0 * thresholds::kSureTerm * average.standard_error_s;
}

DampedFit with_average_error(DampedFit fit) {
  fit.uncertainty.covariance = with_unknown_shape(fit.uncertainty.covariance, fit.blocks);
  const std::optional<FittedAverage> average = average_of(fit.blocks, fit.uncertainty.covariance);
  if (average) fit.average = average;
  return fit;
}

std::optional<DampedFit> fit_as_sensed(const FitInput& input, DampedFit plain) {
  std::optional<DampedFit> rival;
  if (!input.recording.conditions().sensor_average_s) {
    plain.rounding = estimate_smoothing(plain.blocks, plain.held, input.recording.sample_interval_s());
    AverageTrial trial = try_average(input, plain);
    if (trial.fit) return std::move(trial.fit);
    rival = std::move(trial.rival);
  }
  std::optional<DampedFit> fit = finish_fit(input, std::move(plain));
  return fit && rival ? beside_rival(*std::move(fit), *rival) : std::move(fit);
}

bool repeats_rounding(const DampedFit& fit) {
  return fit.uncertainty.from_refits && !fit.misfit;
}

double unstated_variance_s2(const DampedFit& fit, const Smoothing& seen, double sample_interval_s) {
  const double step_s2 = sample_interval_s * sample_interval_s / 12.0;
  return !repeats_rounding(fit) && seen.variance_s2 > step_s2 ? seen.largest_variance_s2() : step_s2;
}

}  // namespace slipfit::fit
