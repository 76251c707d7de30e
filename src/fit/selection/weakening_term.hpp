#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fit/selection/solution.hpp"
#include "fit/selection/tiers.hpp"

namespace slipfit::fit {

/// The fit with friction that weakens over a slip distance (docs/model.md section 9), one parameter more, and whether
/// the data pay for it: Candidate::chosen, with the reason.
struct WeakeningTrial {
  std::optional<DampedFit> fit;  ///< empty: there is none
  Candidate candidate;
  std::string average_caveat{};     ///< of the fit that stays where this is not chosen: DampedFit::average_caveat
  std::vector<DampedFit> rivals{};  ///< of the fit that stays where this is not chosen: not ruled out
};

/// `coulomb`: the fit of the same recording under Coulomb friction. `forced`: a tier that the user asks for; this one
/// is then fitted to all cycles, however little some of them promise.
WeakeningTrial try_weakening(const FitInput& input, const DampedFit& coulomb, std::optional<Tier> forced);

/// The Coulomb fit shows a sign of it: slips that are not shaped like the model's, or rounded.
bool may_weaken(const FitInput& input, const DampedFit& coulomb);

}  // namespace slipfit::fit
