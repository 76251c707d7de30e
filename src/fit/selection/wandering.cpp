#include "fit/selection/wandering.hpp"

#include <cmath>

#include "core/fit_thresholds.hpp"
#include "fit/inference/uncertainty.hpp"

namespace slipfit::fit {

bool level_wanders(const BlockFit& wandering, const BlockFit& polynomial, const Held& held) {
  const Uncertainty rich = estimate_uncertainty(wandering, {held, false});
  const Uncertainty poor = estimate_uncertainty(polynomial, {held, false});
  const auto extra = static_cast<double>(wandering.size() - polynomial.level().terms);
  const double noise2 = std::pow(rich.noise / wandering.scales().noise, 2);
  return (poor.chi2 - rich.chi2) / extra > thresholds::kWanderingRatio * noise2;
}

}  // namespace slipfit::fit
