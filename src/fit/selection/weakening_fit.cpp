#include "fit/selection/weakening_fit.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>

#include "core/fit_thresholds.hpp"
#include "fit/inference/misfit.hpp"
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
  const double samples = median_slip_time_s(coulomb.blocks) / step_s;
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
  const double share = coulomb.average ? 1.0 : thresholds::kHalvedStack;
  candidate.chosen = gain > thresholds::kTierPrice && sigmas > thresholds::kSureTerm && after <= share * before;
  candidate.reason += candidate.chosen ? ": the slip distance is justified"
                                       : fmt::format(": it takes {:g} lower, {:g} standard errors and half",
                                                     thresholds::kTierPrice, thresholds::kSureTerm);
  return candidate;
}

}  // namespace

bool may_weaken(const DampedFit& coulomb) {
  return coulomb.misfit || coulomb.refused_damping || coulomb.average;
}

WeakeningTrial try_weakening(const FitInput& input, const DampedFit& coulomb, std::optional<Tier> forced) {
  WeakeningTrial trial{std::nullopt, {Tier::Weakening, 4, std::nullopt, std::nullopt, false, {}}, std::nullopt};
  trial.candidate.reason = hindrance(input, coulomb);
  if (!trial.candidate.reason.empty()) return trial;
  const double missed = stacked_residual(coulomb.blocks, coulomb.blocks).size;
  trial.fit = fit_weakening(input, coulomb, forced == Tier::Weakening ? std::nullopt : std::optional(missed));
  if (!trial.fit) {
    trial.candidate.reason =
        "no slip distance between 0 and (F_s - F_k) / k halves what the slips of Coulomb friction miss";
    return trial;
  }
  const double effective = effective_samples(*trial.fit);
  trial.candidate = candidate_of(*trial.fit, Tier::Weakening, 4, effective);
  const Candidate other = candidate_of(coulomb, Tier::Damped, coulomb.average ? 4 : 3, effective);
  const double gain = *other.aicc - *trial.candidate.aicc;
  trial.candidate = judged(std::move(trial.candidate), *trial.fit, coulomb, gain, missed);
  if (coulomb.average && !trial.candidate.chosen && std::abs(gain) < thresholds::kTierPrice) {
    trial.warning = Warning{"samples_averaged",
                            fmt::format("friction that weakens over a slip distance of {:.2g} um explains the slips as "
                                        "well as the average of the sensor: the two cannot be told apart",
                                        1e6 * slip_distance_m(*trial.fit))};
  }
  return trial;
}

}  // namespace slipfit::fit
