#include "fit/selection/average_term.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/statistics.hpp"
#include "core/thresholds.hpp"
#include "fit/cycle/sensor.hpp"
#include "fit/inference/smoothing.hpp"
#include "fit/selection/finish.hpp"
#include "fit/selection/solution.hpp"
#include "fit/selection/stated_mass.hpp"
#include "fit/selection/term_fitter.hpp"
#include "fit/selection/tiers.hpp"

namespace slipfit::fit {
namespace {

/// Variance of an impulse response with a long tail that rounds slips as much as an average of variance 1.
constexpr double kLongTail = 3.0;

/// Chi-square of one parameter by which a worse fit is not ruled out at 95 %.
constexpr double kNotRuledOut = kNormalQuantile * kNormalQuantile;

/// Rounded slips, slips that are not shaped like the model's, or slips without damping: an average that lasts longer
/// than the slip takes it away. Falls within a step of the clock show nothing of it.
bool may_be_averaged(const FitInput& input, const DampedFit& plain) {
  const double step_s = input.recording.sample_interval_s();
  if (!(median_slip_s(plain.blocks) > step_s) || noise_exceeds_shape(input.quality.noise_rms, plain)) return false;
  const std::optional<Smoothing>& seen = plain.rounding;
  const double zeta = plain.blocks.parameters.values(kDamping);
  const bool is_damped = zeta > thresholds::kClearSigmas * damping_error(plain);
  return plain.misfit || plain.refused_damping || !is_damped || (seen && seen->exceeds_step(step_s));
}

bool is_shaped(const std::optional<SegmentMisfit>& misfit) {
  return !misfit || misfit->chance > thresholds::kMisfitChance;
}

/// Returns whether the clock resolves the slips behind the average: shorter ones lend their own time to it.
bool is_resolved(const BlockFit& fit, double sample_interval_s) {
  return median_slip_s(fit) > thresholds::kResolvedSamples * sample_interval_s;
}

/// Returns whether the slips have the shape of the model's once the averaging is taken out, and are resolved. A few
/// cycles decide it.
bool is_valid_slip(const DampedFit& fit, double sample_interval_s) {
  const double negative = -thresholds::kLikelySigmas * damping_error(fit);
  return is_shaped(fit.misfit) && !fit.refused_damping && fit.blocks.parameters.values(kDamping) > negative &&
         resting_share(fit.blocks) >= thresholds::kRestickShare && is_resolved(fit.blocks, sample_interval_s);
}

/// Returns whether the slips and W can be distinguished.
bool slip_is_identifiable(const DampedFit& fit) {
  return damping_error(fit) < thresholds::kInformativeDamping && average_is_identifiable(*fit.average);
}

/// Returns whether a lag of first order is ten times less likely on cycles that are wide enough to show it.
bool rules_out_lag(const FitInput& input, const DampedFit& plain, const BlockFit& average) {
  const double lag_s = average.sensor().average_s / std::sqrt(12.0);
  const double longest_lag_s = std::sqrt(kLongTail) * lag_s;
  const auto fitter = TermFitter::create(input, plain, kForgottenLags * longest_lag_s);
  const std::optional<Minimum> best = fitter ? fitter->near(average) : std::nullopt;
  if (!best) return false;
  const std::optional<Minimum> lag =
      fitter->behind_filter(best->blocks, std::array{FilterStart{1, lag_s}, FilterStart{1, longest_lag_s}});
  return !lag || fitter->gain_on_some(*best, *lag) > thresholds::kEvidence;
}

/// Twice the logarithm of how much more likely a stated mass is by `fit` than by `plain`; 0 where it agrees with
/// neither.
double gain_by_mass(const FitInput& input, const DampedFit& fit, const DampedFit& plain) {
  const Conditions& conditions = input.recording.conditions();
  if (!agrees_with_stated_mass(conditions, fit)) return 0.0;
  return std::pow(sigmas_of_stated_mass(conditions, plain), 2) - std::pow(sigmas_of_stated_mass(conditions, fit), 2);
}

/// The fit of all cycles that explains them best, and another average that does so as well.
struct Found {
  std::optional<DampedFit> best;
  double gain_on_samples = 0.0;  ///< twice the logarithm of how much more likely `best` makes them than the plain fit
  std::optional<DampedFit> other;
};
Found best_fit(const FitInput& input, const TermFitter& fitter, const DampedFit& plain,
               const std::vector<Minimum>& minima) {
  const double sample_interval_s = input.recording.sample_interval_s();
  Found found;
  for (const Minimum& minimum : minima) {
    std::optional<DampedFit> next = fitter.fit(minimum.blocks);
    if (!next || !is_valid_slip(*next, sample_interval_s)) continue;
    double gain_on_samples = gain_on_same_samples(*next, plain) + 2.0;  // without the price of the parameter
    if (!(gain_on_samples + gain_by_mass(input, *next, plain) > -kNotRuledOut)) continue;
    next = with_average_error(*std::move(next));
    if (!found.best) {
      found.best = std::move(next);
      found.gain_on_samples = gain_on_samples;
      continue;
    }
    const double gain = gain_of(*next, *found.best);
    if (gain > 0.0) {
      std::swap(found.best, next);
      std::swap(found.gain_on_samples, gain_on_samples);
    }
    const double apart_s = std::abs(next->average->seconds - found.best->average->seconds);
    const bool is_another = apart_s > thresholds::kClearSigmas * found.best->average->standard_error_s;
    if (is_another && std::abs(gain) < thresholds::kTierPrice) found.other = std::move(next);
  }
  return found;
}

/// Holds the fit with an average of the instrument, or that fit as a rival of the fit without one.
struct AverageTrial {
  std::optional<DampedFit> fit{};    ///< empty: not taken
  std::optional<DampedFit> rival{};  ///< not taken, but not ruled out, though its w_n and zeta are others
};

/// Tries the fit with one parameter more, the time W over which the instrument averages its samples (docs/model.md
/// section 7), where it is not stated and `plain`, the fit without, shows a sign of it. Its covariance includes that of
/// W. It is not taken where W does not explain all that `plain` misses of the slips or a sensor of first order explains
/// it as well. Where the slips do not determine W, DampedFit::fall_caveat says so; where another W explains them as
/// well, intervals include both fits.
AverageTrial try_average(const FitInput& input, const DampedFit& plain) {
  if (!may_be_averaged(input, plain)) return {};
  const std::optional<TermFitter> fitter = TermFitter::create(input, plain);
  if (!fitter) return {};
  std::vector<Minimum> minima = fitter->minima({.average = true}).found;
  std::optional<Minimum> without;  // only where a minimum remains to be compared
  std::erase_if(minima, [&](const Minimum& minimum) {
    if (!is_resolved(minimum.blocks, input.recording.sample_interval_s())) return true;
    if (!is_shaped(find_misfit(minimum.blocks, tolerated_misfit(input.quality)))) return true;
    if (!without) without = fitter->plain();
    const bool may_pay = fitter->gain_on_all(minimum, *without) > 0.5 * thresholds::kTierPrice;
    return !may_pay &&
           !(hides_damping(minimum.blocks) && fitter->gain_on_some(minimum, *without) > -2.0 * kNotRuledOut);
  });
  if (minima.empty()) return {};
  auto [fit, gain_on_samples, other] = best_fit(input, *fitter, plain, minima);
  // An average over half of the sticks makes any wave of them.
  if (!fit || !(2.0 * fit->average->seconds < median_stick_s(fit->blocks))) return {};
  const double by_mass = gain_by_mass(input, *fit, plain);
  const bool is_taken = gain_on_samples + by_mass > thresholds::kTierPrice &&
                        (by_mass > thresholds::kTierPrice || rules_out_lag(input, plain, fit->blocks));
  if (!is_taken && !hides_damping(fit->blocks)) return {};
  if (!is_taken) return {std::nullopt, std::move(fit)};
  if (!slip_is_identifiable(*fit)) {
    fit->fall_caveat = average_is_identifiable(*fit->average)
                           ? "the sensor averaging conceals the shape of the slips"
                           : "the data cannot separate the slips from the sensor averaging that rounds them";
  }
  if (other) fit = widened_by_rival(*std::move(fit), *other);
  return {std::move(fit), std::nullopt};
}

}  // namespace

bool hides_damping(const BlockFit& fit) {
  return std::exp(fit.parameters.values(kLogFrequency)) * fit.sensor().average_s > thresholds::kHidingAverage;
}

bool average_is_identifiable(const FittedAverage& average) {
  return average.seconds > 2.0 * thresholds::kClearSigmas * average.standard_error_s;
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
  return fit && rival ? widened_by_rival(*std::move(fit), *rival) : std::move(fit);
}

std::optional<DampedFit> rise_behind_average(const FitInput& input, const RiseDraft& draft) {
  if (!draft.unproven || input.recording.conditions().sensor_average_s) return std::nullopt;
  DampedFit risen = *draft.unproven;
  risen.rounding = estimate_smoothing(risen.blocks, risen.held, input.recording.sample_interval_s());
  AverageTrial trial = try_average(input, risen);
  return trial.fit && proves_rise(*trial.fit, draft) ? std::move(trial.fit) : std::nullopt;
}

bool repeats_rounding(const DampedFit& fit) {
  return fit.uncertainty.from_refits && !fit.misfit;
}

double unstated_variance_s2(const DampedFit& fit, const Smoothing& seen, double sample_interval_s) {
  // The moves are those of little averaging; more bends them: 24 % at 4 samples in a slip, 11 % at 6.
  constexpr double kBend = 4.0;
  constexpr double kMostBend = 0.25;
  const double of_step_s2 = sample_interval_s * sample_interval_s / 12.0;
  const double omega = std::exp(fit.blocks.parameters.values(kLogFrequency));
  const double step_s2 = of_step_s2 * (1.0 + std::min(kMostBend, kBend * omega * omega * of_step_s2));
  if (repeats_rounding(fit)) return step_s2;
  const double largest_s2 = seen.largest_variance_s2();
  const bool is_shown = median_slip_s(fit.blocks) > thresholds::kSlipSamples * sample_interval_s;
  return seen.variance_s2 > step_s2 ? largest_s2 : std::clamp(largest_s2, is_shown ? 0.0 : step_s2, step_s2);
}

}  // namespace slipfit::fit
