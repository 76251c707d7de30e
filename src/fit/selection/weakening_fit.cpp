#include "fit/selection/weakening_fit.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>

#include "core/fit_thresholds.hpp"
#include "core/thresholds.hpp"
#include "fit/inference/misfit.hpp"
#include "fit/selection/carried_fit.hpp"
#include "fit/selection/weakening_fitter.hpp"

namespace slipfit::fit {
namespace {

double slip_distance_m(const DampedFit& fit) {
  return fit.blocks.scales().slip_distance_m * std::pow(fit.blocks.parameters.globals[kFrictionSlope], 2);
}

/// Why it cannot even be tried; empty: it can.
std::string hindrance(const FitInput& input, const DampedFit& coulomb) {
  if (coulomb.blocks.scales().sensor_lag_s > 0.0) return "it is not fitted with a sensor of first order";
  const double step_s = input.recording.sample_interval_s();
  const double samples = median_slip_s(coulomb.blocks) / step_s;
  return samples < thresholds::kShapeSamples ? too_few_samples(samples, step_s) : std::string();
}

/// Sets what the fit says for and against it. `before`: stacked residual of the Coulomb fit.
Candidate judged(Candidate candidate, const DampedFit& fit, const DampedFit& coulomb, double gain, double before) {
  const double sigmas = sigmas_of_distance(fit);
  const double after = stacked_residual(fit.blocks, coulomb.blocks).size;
  candidate.reason = fmt::format(
      "AICc {:.1f} {} than under Coulomb friction, D_c {:.1f} of its standard errors, mean residual over the phase of "
      "the slip {:.2g} % of the onset force in place of {:.2g} %",
      std::abs(gain), gain < 0.0 ? "higher" : "lower", sigmas, 100.0 * after, 100.0 * before);
  if (!(damping_error(fit) < thresholds::kTellingDamping)) {
    candidate.reason += fmt::format("; the standard error of the damping ratio is {:.2g}", damping_error(fit));
    return candidate;
  }
  // An average of the sensor takes as many parameters and explains the roundness, not the asymmetry of the slip.
  const bool is_rounded = coulomb.average || coulomb.blocks.scales().law == FrictionLaw::Weakening;
  const double share = is_rounded ? 1.0 : thresholds::kHalvedStack;
  candidate.chosen = gain > thresholds::kTierPrice && sigmas > thresholds::kSureTerm && after <= share * before;
  candidate.reason += candidate.chosen ? ": the slip distance is justified"
                                       : fmt::format(": it takes {:g} lower, {:g} standard errors and half",
                                                     thresholds::kTierPrice, thresholds::kSureTerm);
  return candidate;
}

/// Where a search for an average beside the slip distance begins; empty: one of the two explains the slips.
std::optional<double> start_of_average_s(const FitInput& input, const DampedFit& coulomb,
                                         const std::optional<DampedFit>& weakening) {
  if (input.recording.conditions().sensor_average_s) return std::nullopt;
  if (coulomb.average) return coulomb.average->seconds;
  const double step_s = input.recording.sample_interval_s();
  if (!weakening || !weakening->rounding || !weakening->rounding->exceeds_step(step_s)) return std::nullopt;
  return std::sqrt(12.0 * weakening->rounding->variance_s2);
}

/// Where a search for the other minimum begins: much averaging of quick slips looks like little of slow ones. The
/// shares of the average in what draws the fall out add up to about 0.75 then (docs/model.md section 7).
double mirrored_s(const DampedFit& fit) {
  constexpr double kBoth = 0.75;
  constexpr double kLeast = 0.05;
  constexpr double kSlip2 = 5.6;  // W^2 of an average that draws the fall out as much as the slip itself does
  const double omega = std::exp(fit.blocks.parameters.globals[kLogFrequency]);
  const double seen2 = std::pow(omega * fit.average->seconds, 2) + kSlip2;
  const double share = 1.0 - kSlip2 / seen2;
  return std::sqrt(std::max(kLeast, kBoth - share) * seen2) / omega;
}

/// A fit of both, by how much its AICc is lower than the rival's, and whether no other minimum is as good.
struct Minimum {
  DampedFit fit;
  double gain = 0.0;
  bool is_sure = true;
};

/// The better of two fits from either minimum.
Minimum better_minimum(const FitInput& input, const DampedFit& coulomb, const DampedFit& rival, Minimum first) {
  std::optional<DampedFit> second = fit_averaged_weakening(input, coulomb, mirrored_s(first.fit), rival);
  if (!second) return first;
  const double ahead = gain_on_same_samples(*second, first.fit) + 2.0;  // as many parameters
  const FittedAverage& average = *first.fit.average;
  const bool is_same =
      std::abs(second->average->seconds - average.seconds) < thresholds::kSureTerm * average.standard_error_s;
  first.is_sure = is_same || std::abs(ahead) > thresholds::kTierPrice;
  if (!(ahead > 0.0)) return first;
  const double gain = gain_on_same_samples(*second, rival);
  return {*std::move(second), gain, first.is_sure};
}

/// F_s - F_k lies between half of the fall and the drop between the ramps whatever D_c and zeta are, and slips rest:
/// others follow the samples by other means than a slip.
bool has_slips_of_the_model(const DampedFit& fit) {
  constexpr double kRoom = 0.05;
  const SawtoothFit sawtooth = fit_sawtooth(fit);
  double difference = 0.0;
  for (std::size_t i = 0; i < fit.blocks.size(); ++i) {
    difference += fit.blocks.state(i).onset_force / static_cast<double>(fit.blocks.size());
  }
  return resting_share(fit.blocks) >= thresholds::kRestickShare && difference > (0.5 - kRoom) * sawtooth.fall &&
         difference < (1.0 + kRoom) * sawtooth.drop;
}

/// What a fit of both says for and against it beside `single`, the fit with one of the two. `before`: stacked residual
/// of `single`.
Candidate judged_both(const Minimum& both, const DampedFit& single, double before) {
  const DampedFit& fit = both.fit;
  Candidate candidate =
      judged(candidate_of(fit, Tier::Weakening, 5, effective_samples(fit)), fit, single, both.gain, before);
  const bool tells_average = fit.average->seconds > thresholds::kSureTerm * fit.average->standard_error_s;
  if (!tells_average || !has_slips_of_the_model(fit)) candidate.chosen = false;
  return candidate;
}

/// Friction that weakens, seen through an average, where this explains more than either of the two.
WeakeningTrial with_both(WeakeningTrial trial, const FitInput& input, const DampedFit& coulomb) {
  const std::optional<double> start_s = start_of_average_s(input, coulomb, trial.fit);
  if (!start_s) return trial;
  const DampedFit& single = trial.candidate.chosen ? *trial.fit : coulomb;
  const StackedResidual before = stacked_residual(single.blocks, coulomb.blocks);
  if (before.size < before.by_chance) return trial;
  std::optional<DampedFit> first = fit_averaged_weakening(input, coulomb, *start_s, single);
  if (!first) return trial;
  const double gain = gain_on_same_samples(*first, single);
  if (!(gain > thresholds::kTierPrice)) return trial;
  Minimum both{*std::move(first), gain};
  if (judged_both(both, single, before.size).chosen) {
    both = better_minimum(input, coulomb, single, std::move(both));
    Candidate candidate = judged_both(both, single, before.size);
    if (both.is_sure && candidate.chosen) return {std::move(both.fit), std::move(candidate), {}, std::nullopt};
  }
  if (stacked_residual(both.fit.blocks, coulomb.blocks).size > thresholds::kHalvedStack * before.size) return trial;
  trial.fall_doubt =
      "friction that weakens over a slip distance and an average of the sensor together explain the slips better "
      "than either, and cannot be told apart: state the average with --sensor-average";
  return trial;
}

}  // namespace

bool may_weaken(const DampedFit& coulomb) {
  return coulomb.misfit || coulomb.refused_damping || coulomb.average;
}

WeakeningTrial try_weakening(const FitInput& input, const DampedFit& coulomb, std::optional<Tier> forced) {
  WeakeningTrial trial{std::nullopt, {Tier::Weakening, 4, std::nullopt, std::nullopt, false, {}}, {}, std::nullopt};
  trial.candidate.reason = hindrance(input, coulomb);
  if (!trial.candidate.reason.empty()) return trial;
  const double missed = stacked_residual(coulomb.blocks, coulomb.blocks).size;
  const std::optional<double> asked = forced == Tier::Weakening ? std::nullopt : std::optional(missed);
  trial.fit = fit_weakening(input, coulomb, asked);
  if (trial.fit) {
    const double effective = effective_samples(*trial.fit);
    trial.candidate = candidate_of(*trial.fit, Tier::Weakening, 4, effective);
    const Candidate other = candidate_of(coulomb, Tier::Damped, coulomb.average ? 4 : 3, effective);
    const double gain = *other.aicc - *trial.candidate.aicc;
    trial.candidate = judged(std::move(trial.candidate), *trial.fit, coulomb, gain, missed);
    if (coulomb.average && !trial.candidate.chosen && std::abs(gain) < thresholds::kTierPrice) {
      trial.fall_doubt = fmt::format(
          "friction that weakens over a slip distance of {:.2g} um explains the slips as well as the average of the "
          "sensor: the two cannot be told apart",
          1e6 * slip_distance_m(*trial.fit));
      trial.warning = Warning{"samples_averaged", trial.fall_doubt};
    }
  } else {
    trial.candidate.reason =
        "no slip distance between 0 and (F_s - F_k) / k halves what the slips of Coulomb friction miss";
  }
  return with_both(std::move(trial), input, coulomb);
}

}  // namespace slipfit::fit
