#include "fit/selection/chosen_fit.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "fit/selection/average_term.hpp"
#include "fit/selection/ring_down_fit.hpp"
#include "fit/selection/rise_term.hpp"
#include "fit/selection/stated_mass.hpp"
#include "fit/selection/tiers.hpp"
#include "fit/selection/weakening_term.hpp"

namespace slipfit::fit {
namespace {

/// Friction that weakens over a slip distance in place of Coulomb friction where the data, or the user, want it.
Chosen with_weakening(Chosen chosen, const FitInput& input, std::optional<Tier> forced) {
  const bool is_asked = forced == Tier::Weakening;
  if (!is_asked && (forced || !may_weaken(input, chosen.fits.damped))) return chosen;
  WeakeningTrial trial = try_weakening(input, chosen.fits.damped, forced);
  Candidate& candidate = trial.candidate;
  const std::string caveat = candidate.chosen ? "" : candidate.reason;
  if (is_asked) candidate = requested(std::move(candidate));
  if (candidate.chosen) {
    for (Candidate& other : chosen.candidates) other.chosen = false;
    if (trial.fit) {
      if (!caveat.empty()) trial.fit->law_caveat = caveat;
      chosen.fits = {fit_sawtooth(*trial.fit), std::nullopt, *std::move(trial.fit)};
      chosen.resolution = resolution_of(input.recording, chosen.fits);
      const bool is_negative = chosen.fits.damped.blocks.parameters.values(kDamping) < 0.0;
      if (is_negative && !chosen.fits.damped.held[kDamping])
        chosen.fits.undamped = fit_undamped(chosen.fits.damped, false);
    } else {
      chosen.fits.damped.law_caveat = caveat;
      chosen.resolution.slip_resolved = chosen.resolution.damping_resolved = false;
      chosen.resolution.reason = caveat;
    }
  }
  for (const DampedFit& rival : trial.rivals) {
    chosen.fits.damped = widened_by_rival(std::move(chosen.fits.damped), rival);
  }
  chosen.fits.damped.average_caveat = trial.average_caveat;
  chosen.candidates.push_back(std::move(candidate));
  if (!trial.average_caveat.empty()) {
    chosen.warnings.push_back(Warning{"samples_averaged", trial.average_caveat});
  }
  return chosen;
}

Chosen choose_law(const FitInput& input, DampedFit damped, std::optional<Tier> forced) {
  TierFits fits{fit_sawtooth(damped), std::nullopt, std::move(damped)};
  Resolution resolution = resolution_of(input.recording, fits);
  if (forced == Tier::Sawtooth) {
    std::vector<Candidate> candidates = choose_tier(fits, resolution, forced);
    resolution.slip_resolved = resolution.damping_resolved = false;
    resolution.reason = "the slips of the sawtooth model, which --tier requests, take no time";
    return {std::move(fits), std::move(resolution), std::move(candidates)};
  }
  const bool undamped_may_lose = resolution.damping_resolved && forced != Tier::Undamped;
  if (!fits.damped.held[kDamping]) fits.undamped = fit_undamped(fits.damped, undamped_may_lose);
  const std::optional<Tier> of_coulomb = forced == Tier::Weakening ? std::nullopt : forced;
  std::vector<Candidate> candidates = choose_tier(fits, resolution, of_coulomb);
  return with_weakening({std::move(fits), resolution, std::move(candidates)}, input, forced);
}

/// Chooses the law from the slips alone. The result is empty where no fit of them is found.
std::optional<Chosen> choose(const FitInput& input, std::optional<Tier> forced, const AbortPredicate& should_abort) {
  std::optional<RiseDraft> draft = draft_with_rise(input, should_abort);
  if (!draft) return std::nullopt;
  std::optional<DampedFit> fit = rise_behind_average(input, *draft);
  if (!fit) fit = fit_as_sensed(input, std::move(draft->fit));
  if (!fit) return std::nullopt;
  return choose_law(input, fit_with_mass(input, *std::move(fit)), forced);
}

/// The law that the slips chose, with w_n and zeta by slips and ring-down together.
std::optional<Chosen> with_motion(Chosen chosen, const FitInput& input, std::optional<Tier> forced,
                                  const FreeMotion& motion) {
  DampedFit& slips = chosen.fits.damped;
  const std::vector<Coordinates> rivals = std::exchange(slips.rivals, {});
  slips.fall_caveat.clear();
  std::optional<DampedFit> fit = held_at(motion, input, std::move(slips));
  if (!fit) return std::nullopt;
  // What another fit makes of w_n and zeta the ring-down has decided.
  fit->rivals = rivals;
  for (Coordinates& rival : fit->rivals) rival.segment<2>(kLogFrequency) = motion.values;
  const bool is_coulomb = fit->blocks.scales().law == FrictionLaw::Coulomb;
  chosen.fits = {fit_sawtooth(*fit), std::nullopt, *std::move(fit)};
  chosen.resolution = resolution_of(input.recording, chosen.fits);
  if (!is_coulomb) return chosen;
  std::vector<Candidate> of_coulomb = choose_tier(chosen.fits, chosen.resolution, forced);
  std::copy(of_coulomb.begin(), of_coulomb.end(), chosen.candidates.begin());
  return chosen;
}

}  // namespace

std::optional<Chosen> choose_with_ring_down(const FitInput& input, const FitOptions& options,
                                            const AbortPredicate& should_abort) {
  std::optional<Chosen> chosen = choose(input, options.tier, should_abort);
  if (!chosen || !options.ring_down || !chosen->resolution.slip_resolved) return chosen;
  const auto evidence = ring_evidence(input.recording, chosen->fits.damped, *options.ring_down);
  if (!evidence) return chosen;
  if (evidence->same.differs) chosen->warnings.push_back(differing_motions(evidence->slips, evidence->rings));
  if (!evidence->same.both) return chosen;
  std::optional<Chosen> joined = with_motion(*chosen, input, options.tier, *evidence->same.both);
  return joined ? std::move(joined) : std::move(chosen);
}

}  // namespace slipfit::fit
