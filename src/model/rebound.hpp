#pragma once

#include <cmath>
#include <numbers>

namespace slipfit::model {

/// Returns how far a slip under constant friction falls below the kinetic level, over how far it began above it, at a
/// damping ratio in [0, 1): exp(-pi zeta / sqrt(1 - zeta^2)). Half a damped period lies between the two, docs/model.md
/// (2).
inline double rebound_at(double damping_ratio) {
  return std::exp(-std::numbers::pi * damping_ratio / std::sqrt(1.0 - damping_ratio * damping_ratio));
}

/// Returns the damping ratio with this rebound, which is in (0, 1].
inline double damping_ratio_with(double rebound) {
  const double decrement = std::log(1.0 / rebound) / std::numbers::pi;
  return decrement / std::hypot(1.0, decrement);
}

}  // namespace slipfit::model
