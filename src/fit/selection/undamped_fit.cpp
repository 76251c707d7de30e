#include <cmath>
#include <utility>

#include "fit/problem/solve.hpp"
#include "fit/selection/damped_fit.hpp"
#include "fit/selection/tiers.hpp"

namespace slipfit::fit {
namespace {

/// Worse than the damped fit by twice what the tiers must differ by: joined ramps would make it worse still.
bool is_lost(double loose_chi2, const DampedFit& damped) {
  constexpr double kLost = 20.0;
  double damped_chi2 = 0.0;
  for (const double sum : damped.blocks.sums_of_squares()) damped_chi2 += sum;
  const double worse = (loose_chi2 - damped_chi2) / damped.uncertainty.chi2;
  return effective_samples(damped) * std::log1p(worse) > kLost;
}

/// Returns whether the damped fit does not rule zeta = 0 out, and its cycles are where the undamped fit has them.
bool is_near(const DampedFit& damped) {
  constexpr double kNear = 2.0;
  return std::abs(damped.blocks.parameters.values(kDamping)) < kNear * damping_error(damped);
}

}  // namespace

std::optional<DampedFit> fit_undamped(const DampedFit& damped, bool may_lose) {
  const BlockFit& from = damped.blocks;
  BlockFit blocks = from;
  blocks.parameters.values(kDamping) = 0.0;
  Held held = damped.held;
  held[kDamping] = true;
  bool lost = false;
  if (!is_near(damped)) {
    // From a zeta far below 0 the joined ramps hold the cycles where they are, at a false minimum: loose ones first.
    SolveOptions rough{held, false, true};
    rough.tolerance = 0.1;
    const double loose_chi2 = solve(blocks, rough);
    if (!std::isfinite(loose_chi2)) return std::nullopt;
    lost = may_lose && is_lost(loose_chi2, damped);
  }
  const bool joined = damped.continuous && !lost;
  if (!lost && !std::isfinite(solve(blocks, {held, joined, true}))) return std::nullopt;
  DampedFit result{std::move(blocks),   joined,          held, damped.refused_damping,
                   damped.half_width_s, damped.excluded, {},   damped.misfit};
  result.uncertainty = estimate_uncertainty(result.blocks, {held, joined});
  // Where the free zeta lies below 0 by chance, 0 is hardly worse: residuals twice as large are a false minimum.
  const bool is_false =
      from.parameters.values(kDamping) < 0.0 && result.uncertainty.noise > 2.0 * damped.uncertainty.noise;
  return is_false ? std::nullopt : std::optional(std::move(result));
}

}  // namespace slipfit::fit
