#pragma once

#include <optional>

#include "fit/inference/ageing_line.hpp"
#include "fit/inference/sweep_coordinates.hpp"

namespace slipfit::fit {

/// Describes a law of kinetic friction other than the exponential one: F_k(0+), and so F_s - F_k(0+), depends on the
/// friction below the speeds that were measured.
struct OtherLaw {
  FrictionLaw law = FrictionLaw::Hyperbolic;
  double difference = 0.0;  ///< F_s - F_k(0+) under it / Units::force
  /// Says how far this law moves F_k(0+) and F_s - F_k(0+).
  Coordinates move = Coordinates::Zero();
};

/// Of the hyperbolic and the logarithmic laws that the recordings do not exclude the one with the largest move. Empty
/// where they exclude all.
std::optional<OtherLaw> other_law(const SweepSolution& exponential, const StaticFriction& kind);

}  // namespace slipfit::fit
