#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "fit/selection/fit_input.hpp"
#include "fit/selection/solution.hpp"

namespace slipfit::fit {

/// Asked once, before all of many cycles are fitted, with the fit of some of them: true ends the fit, which is then
/// empty.
using GiveUp = std::function<bool(const BlockFit& some)>;

/// Where a fit begins: beside another one of the same recording, first without the samples that this left out.
struct Near {
  std::optional<Coordinates> values{};  ///< empty: where the features of the slips lead
  std::vector<std::size_t> excluded{};
  std::shared_ptr<const RiseAfterSlip> reloading{};  ///< of the sticks
  bool level_per_cycle = false;  ///< the other one has a level of its own in every cycle, which is tried then
  int most_iterations = 60;      ///< of a solve of all cycles
  GiveUp give_up{};              ///< empty: never
  bool needs_damping = false;    ///< a fit whose damping ratio is clearly below 0 is empty
};

/// The per-cycle block fit with all that makes it stand real recordings: several starts in zeta, a level that may
/// drift or wander, outliers left out. What finish_fit adds is missing: joined ramps, and more to the uncertainty.
/// Empty: fewer than 3 cycles to fit, or no start converges.
std::optional<DampedFit> draft_damped(const FitInput& input, const Near& near = {});

/// All cycles with no sample, no slip and no line looked for: how badly they fit, roughly.
std::optional<BlockFit> rough_fit(const FitInput& input);

/// The same cycles and level with zeta held at 0, from the damped solution. Where it `may_lose` and has clearly lost to
/// the damped fit, it stays rough and its ramps are not joined.
std::optional<DampedFit> fit_undamped(const DampedFit& damped, bool may_lose);

}  // namespace slipfit::fit
