#include "fit/selection/weakening_term.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/filter_delay.hpp"
#include "core/thresholds.hpp"
#include "fit/inference/smoothing.hpp"
#include "fit/inference/uncertainty.hpp"
#include "fit/selection/average_term.hpp"
#include "fit/selection/solution.hpp"
#include "fit/selection/term_fitter.hpp"
#include "fit/selection/tiers.hpp"
#include "fit/sweep/sweep_data.hpp"

namespace slipfit::fit {
namespace {

double slip_distance_m(const DampedFit& fit) {
  return fit.blocks.scales().slip_distance_m * std::pow(fit.blocks.parameters.values(kSlipDistance), 2);
}

/// Returns why the term cannot even be tried; empty where it can.
std::string hindrance(const FitInput& input, const DampedFit& coulomb) {
  const double step_s = input.recording.sample_interval_s();
  const double samples = median_slip_s(coulomb.blocks) / step_s;
  return samples < thresholds::kShapeSamples ? too_few_samples(samples, step_s) : std::string();
}

/// Returns whether the fit has one of the two terms already. An average takes as many parameters as a slip distance and
/// explains how round a slip is, not how asymmetric: a fit with the other term, or with both, need not halve the
/// stacked residual.
bool has_either_term(const DampedFit& fit) {
  return fit.average || fit.blocks.scales().law == FrictionLaw::Weakening;
}

/// Sets what the fit says for and against it. `before`: stacked residual of the Coulomb fit.
Candidate judged(Candidate candidate, const DampedFit& fit, const DampedFit& coulomb, double gain, double before) {
  const double sigmas = sigmas_of_distance(fit);
  const double after = stacked_residual(fit.blocks, coulomb.blocks).size;
  candidate.reason = fmt::format(
      "AICc {:.1f} {} than under Coulomb friction, D_c {:.1f} of its standard errors, mean residual over the phase of "
      "the slip {:.2g} % of the onset force in place of {:.2g} %",
      std::abs(gain), gain < 0.0 ? "higher" : "lower", sigmas, 100.0 * after, 100.0 * before);
  if (!(damping_error(fit) < thresholds::kInformativeDamping)) {
    candidate.reason += fmt::format("; the standard error of the damping ratio is {:.2g}", damping_error(fit));
    return candidate;
  }
  const double most = has_either_term(coulomb) ? before : thresholds::kHalvedStack * before;
  candidate.chosen = gain > thresholds::kTierPrice && sigmas > thresholds::kClearSigmas && after <= most;
  candidate.reason += candidate.chosen
                          ? ": the slip distance is justified"
                          : fmt::format(": an AICc {:g} lower, {:g} standard errors and half the residual are required",
                                        thresholds::kTierPrice, thresholds::kClearSigmas);
  return candidate;
}

constexpr double kFilterCorner = 3.0;  // over w_n, with which the search for a filter starts
constexpr double kFilterReach = 3.0;   // of 1 / w_n: a filter of fourth order at 3 w_n decays to e^-3
constexpr double kHopeful = 1.1 * thresholds::kHalvedStack;

/// Returns whether the cycles that compare the terms allow for a stacked residual that is half of `missed`, that of
/// `poorer`. It is not required of a fit that takes the place of either term.
bool explains(const Minimum& minimum, const DampedFit& poorer, double missed) {
  if (has_either_term(poorer)) return true;
  const StackedResidual after = stacked_residual(minimum.blocks, poorer.blocks);
  return after.size * after.size - after.by_chance * after.by_chance < std::pow(kHopeful * missed, 2);
}

/// Returns whether the minimum may replace Coulomb friction: by the cycles that compare the terms, its AICc is not
/// clearly higher, and it may halve the stacked residual.
bool promises(const TermFitter& fitter, const Minimum& minimum, const DampedFit& coulomb, double missed) {
  return fitter.gain_on_some(minimum, fitter.plain()) > -thresholds::kTierPrice && explains(minimum, coulomb, missed);
}

/// The fit of all cycles with friction that weakens and no average but a stated one. `missed`: stacked residual of the
/// Coulomb fit. Empty where no start converges, or the law does not promise to be taken and the user does not ask for
/// it.
std::optional<DampedFit> fit_weakening(const FitInput& input, const TermFitter& fitter, const DampedFit& coulomb,
                                       double missed, bool is_asked) {
  const Minima minima = fitter.minima({.weakening = true}, is_asked);
  if (minima.found.empty()) return std::nullopt;
  const Minimum& best = minima.found.front();
  if (!is_asked && !promises(fitter, best, coulomb, missed)) return std::nullopt;
  std::optional<DampedFit> fit = fitter.fit(best.blocks);
  if (fit && !input.recording.conditions().sensor_average_s) {
    fit->rounding = estimate_smoothing(fit->blocks, fit->held, input.recording.sample_interval_s());
  }
  return fit;
}

/// A fit of both, by how much its AICc is lower than the rival's, and whether no other minimum is as good.
struct Both {
  DampedFit fit;
  double gain = 0.0;
  bool is_sure = true;
  std::optional<DampedFit> other{};  ///< as good
};

/// Returns the fit of all cycles with both terms if the cycles that compare the terms show that it may be chosen, and
/// otherwise their own fit. `missed` is the stacked residual of `rival`.
std::optional<Both> best_of_both(const FitInput& input, const TermFitter& fitter, const DampedFit& rival,
                                 double missed) {
  const auto [minima, is_complete] = fitter.minima({.average = true, .weakening = true});
  const std::optional<Minimum> single = fitter.near(rival.blocks);
  if (minima.empty() || !single) return std::nullopt;
  const double gain_on_all = fitter.gain_on_all(minima.front(), *single);
  std::vector<DampedFit> rivals;
  bool may_be_taken = false;
  for (const Minimum& minimum : minima) {
    rivals.push_back(fitter.rival_of(minimum));
    may_be_taken |= explains(minimum, rival, missed) && average_is_identifiable(*rivals.back().average);
  }
  const bool pays = gain_on_all > 0.5 * thresholds::kTierPrice;
  if (!pays || !may_be_taken) {
    Both both{std::move(rivals.front()), gain_on_all - 2.0, false};  // one parameter more
    const bool is_tie = minima.size() > 1 && fitter.gain_on_all(minima[0], minima[1]) < thresholds::kTierPrice;
    if (pays && is_tie) both.other = std::move(rivals[1]);
    return both;
  }
  std::vector<DampedFit> fits;
  bool all_settled = is_complete;
  for (const Minimum& minimum : minima) {
    std::optional<DampedFit> fit = fitter.fit(minimum.blocks);
    if (fit && fit->blocks.sensor().average_s >= input.recording.sample_interval_s()) {
      fits.push_back(with_average_error(*std::move(fit)));
    } else {
      all_settled = false;
    }
  }
  if (fits.empty()) return std::nullopt;
  if (fits.size() == 1) {
    const double gain = gain_on_same_samples(fits[0], rival);
    return Both{std::move(fits[0]), gain, all_settled};
  }
  const double ahead = gain_on_same_samples(fits[1], fits[0]) + 2.0;  // as many parameters
  const FittedAverage average = *fits[0].average;
  const bool is_same =
      std::abs(fits[1].average->seconds - average.seconds) < thresholds::kClearSigmas * average.standard_error_s;
  if (ahead > 0.0) std::swap(fits[0], fits[1]);
  const double gain = gain_on_same_samples(fits[0], rival);
  Both both{std::move(fits[0]), gain, is_same || std::abs(ahead) > thresholds::kTierPrice};
  if (!both.is_sure) both.other = std::move(fits[1]);
  return both;
}

/// F_s - F_k lies between half of the fall and the drop between the ramps whatever D_c and zeta are, and slips rest:
/// others follow the samples by other means than a slip.
bool has_slips_of_the_model(const DampedFit& fit) {
  constexpr double kRoom = 0.05;
  const SawtoothFit sawtooth = fit_sawtooth(fit);
  const double difference = mean_onset_force(fit);
  return resting_share(fit.blocks) >= thresholds::kRestickShare && difference > (0.5 - kRoom) * sawtooth.fall &&
         difference < (1.0 + kRoom) * sawtooth.drop;
}

/// Returns what a fit of both says for and against it, compared with `single`, the fit with one of the two. `before` is
/// the stacked residual of `single`.
Candidate judged_both(const Both& both, const DampedFit& single, double before) {
  const DampedFit& fit = both.fit;
  Candidate candidate =
      judged(candidate_of(fit, Tier::Weakening, 5, effective_samples(fit)), fit, single, both.gain, before);
  if (!average_is_identifiable(*fit.average) || !has_slips_of_the_model(fit)) candidate.chosen = false;
  return candidate;
}

/// Friction that weakens, seen through an average, where this explains more than either of the two. `missed`: the
/// stacked residual of `coulomb`.
WeakeningTrial with_both(WeakeningTrial trial, const FitInput& input, const TermFitter& fitter,
                         const DampedFit& coulomb, const StackedResidual& missed) {
  if (input.recording.conditions().sensor_average_s) return trial;
  const DampedFit& single = trial.candidate.chosen ? *trial.fit : coulomb;
  const StackedResidual before = trial.candidate.chosen ? stacked_residual(single.blocks, coulomb.blocks) : missed;
  if (!coulomb.average && before.size < before.by_chance) return trial;
  std::optional<Both> both = best_of_both(input, fitter, single, before.size);
  if (!both) return trial;
  Candidate candidate = judged_both(*both, single, before.size);
  if (both->is_sure && candidate.chosen) return {std::move(both->fit), std::move(candidate)};
  // A stated mass determines w_n, which the rival does not know of.
  if (!coulomb.mass_gives_frequency && both->gain > -thresholds::kTierPrice) {
    for (const DampedFit* rival : {&both->fit, both->other ? &*both->other : nullptr}) {
      if (rival == nullptr || !has_slips_of_the_model(*rival)) continue;
      if (trial.candidate.chosen) {
        trial.fit = widened_by_rival(*std::move(trial.fit), *rival);
      } else {
        trial.rivals.push_back(*rival);
      }
    }
  }
  return trial;
}

/// Fits all cycles with Coulomb friction behind a low-pass filter of the instrument. The result is empty if the cycles
/// that compare the terms show that `weakening` explains them much better.
std::optional<DampedFit> fit_filter(const FitInput& input, const DampedFit& coulomb, const BlockFit& weakening) {
  const double omega_rad_per_s = std::exp(coulomb.blocks.parameters.values(kLogFrequency));
  const auto fitter = TermFitter::create(input, coulomb, kFilterReach / omega_rad_per_s);
  if (!fitter) return std::nullopt;
  const auto start_of = [&](std::size_t order) {
    return FilterStart{order, butterworth_delay(order) / (kFilterCorner * omega_rad_per_s)};
  };
  // The orders of most amplifiers and loggers lie between these two.
  const std::optional<Minimum> filter = fitter->behind_filter(coulomb.blocks, std::array{start_of(2), start_of(4)});
  const std::optional<Minimum> rival = fitter->near(weakening);
  if (!filter || !rival || fitter->gain_on_all(*rival, *filter) > kRuledOut) {
    return std::nullopt;
  }
  return fitter->fit(filter->blocks);
}

/// Compares friction that weakens, which was chosen, with a low-pass filter of the instrument, which delays and skews
/// slips as a slow onset does. Where the data do not exclude a filter that nobody stated, intervals include both fits.
WeakeningTrial compared_with_filter(WeakeningTrial trial, const FitInput& input, const DampedFit& coulomb) {
  if (input.recording.conditions().sensor_bandwidth_Hz) return trial;
  const std::optional<DampedFit> filter = fit_filter(input, coulomb, trial.fit->blocks);
  if (!filter || !has_slips_of_the_model(*filter)) return trial;
  const double by_parameters = trial.fit->average ? -2.0 : 0.0;  // W is one more
  if (gain_on_same_samples(*trial.fit, *filter) + 2.0 + by_parameters > thresholds::kTierPrice) return trial;
  const std::size_t order = filter->blocks.scales().sensor_order;
  const double corner_Hz = butterworth_delay(order) / (2.0 * std::numbers::pi * filter->blocks.sensor().lag_s);
  trial.fit = widened_by_rival(*std::move(trial.fit), *filter);
  trial.fit->law_caveat = fmt::format(
      "a low-pass filter of the instrument (order {}, {:.2g} Hz) explains the slips as well as friction that "
      "weakens over a slip distance; --sensor-filter states one",
      order, corner_Hz);
  return trial;
}

}  // namespace

bool may_weaken(const FitInput& input, const DampedFit& coulomb) {
  if (noise_exceeds_shape(input.quality.noise_rms, coulomb)) return false;
  const bool is_rounded = coulomb.rounding && coulomb.rounding->exceeds_step(input.recording.sample_interval_s());
  return coulomb.misfit || coulomb.refused_damping || coulomb.average || is_rounded;
}

WeakeningTrial try_weakening(const FitInput& input, const DampedFit& coulomb, std::optional<Tier> forced) {
  WeakeningTrial trial{std::nullopt, {Tier::Weakening, 4, std::nullopt, std::nullopt, false, {}}};
  trial.candidate.reason = hindrance(input, coulomb);
  if (!trial.candidate.reason.empty()) return trial;
  const std::optional<TermFitter> fitter = TermFitter::create(input, coulomb);
  const StackedResidual missed = stacked_residual(coulomb.blocks, coulomb.blocks);
  if (fitter) trial.fit = fit_weakening(input, *fitter, coulomb, missed.size, forced == Tier::Weakening);
  if (trial.fit) {
    const double effective = effective_samples(*trial.fit);
    trial.candidate = candidate_of(*trial.fit, Tier::Weakening, 4, effective);
    const double gain = gain_on_same_samples(*trial.fit, coulomb) + (coulomb.average ? 2.0 : 0.0);
    trial.candidate = judged(std::move(trial.candidate), *trial.fit, coulomb, gain, missed.size);
    if (coulomb.average && !trial.candidate.chosen && gain > -thresholds::kTierPrice) {
      trial.average_caveat = fmt::format(
          "friction that weakens over a slip distance of {:.2g} um explains the slips as well as the average of the "
          "sensor: the data cannot separate the two",
          1e6 * slip_distance_m(*trial.fit));
      trial.rivals.push_back(*trial.fit);
    }
  } else {
    trial.candidate.reason =
        "no slip distance between 0 and (F_s - F_k) / k halves what the slips of Coulomb friction miss";
  }
  if (fitter) trial = with_both(std::move(trial), input, *fitter, coulomb, missed);
  // Slips that are no damped oscillation under this law determine nothing that a filter could explain otherwise.
  const bool may_be_filtered = trial.candidate.chosen && !trial.fit->refused_damping;
  return may_be_filtered ? compared_with_filter(std::move(trial), input, coulomb) : std::move(trial);
}

}  // namespace slipfit::fit
