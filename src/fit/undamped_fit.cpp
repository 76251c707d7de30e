#include <cmath>
#include <utility>

#include "fit/damped_fit.hpp"

namespace slipfit::fit {

std::optional<DampedFit> fit_undamped(const DampedFit& damped) {
  const BlockFit& from = damped.blocks;
  BlockFit blocks = duplicate(from);
  blocks.parameters.shared[2] = 0.0;
  Held held = damped.held;
  held.damping = true;
  // From a zeta far below 0 the joined ramps hold the cycles where they are, at a false minimum: loose ones first.
  if (damped.continuous && !std::isfinite(blocks.solve({held, false, true}))) return std::nullopt;
  if (!std::isfinite(blocks.solve({held, damped.continuous, true}))) return std::nullopt;
  DampedFit result{std::move(blocks), damped.continuous, held, damped.refused_damping,
                   damped.excluded,   damped.outliers,   {},   damped.misfit};
  result.uncertainty = estimate_uncertainty(result.blocks, held, damped.continuous);
  // Where the free zeta lies below 0 by chance, 0 is hardly worse: residuals twice as large are a false minimum.
  const bool is_false = from.parameters.shared[2] < 0.0 && result.uncertainty.noise > 2.0 * damped.uncertainty.noise;
  return is_false ? std::nullopt : std::optional(std::move(result));
}

}  // namespace slipfit::fit
