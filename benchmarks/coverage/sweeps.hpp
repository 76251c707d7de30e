#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "slipfit/model/motion.hpp"
#include "slipfit/model/velocity_friction.hpp"
#include "slipfit/sweep.hpp"

namespace coverage {

/// A simulated sweep and what was put into it: F_k(v) = f0 + f1 exp(alpha v).
struct Sweep {
  std::uint64_t seed = 0;
  slipfit::Slider slider;
  slipfit::VelocityFriction friction;        ///< of the population
  std::vector<slipfit::SweepEntry> entries;  ///< five speeds, each twice the one before

  /// V times the period at the mean F_s; empty where there is no stick-slip.
  [[nodiscard]] std::optional<double> spacing_m(double speed_m_per_s) const;
};

/// Every number follows from the seed. Two of three sweeps have alpha < 0 with alpha v_c from -0.3 to -3 (v_c: fastest
/// sliding of a slip); in the third 0 < alpha v_c < 0.3, where only the product f1 alpha can be seen. Every second one
/// has scattering static friction.
Sweep make_sweep(std::uint64_t seed);

}  // namespace coverage
