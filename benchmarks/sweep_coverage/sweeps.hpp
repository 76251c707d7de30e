#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "slipfit/pipeline.hpp"
#include "slipfit/sweep.hpp"

namespace sweep_coverage {

/// What was put into a simulated sweep: F_k(v) = f0 + f1 exp(alpha v).
struct Truth {
  double stiffness_N_per_m = 0.0;
  double natural_frequency_rad_per_s = 0.0;
  double damping_ratio = 0.0;
  double static_friction_N = 0.0;  ///< of the population
  double f0_N = 0.0, f1_N = 0.0;
  double alpha_s_per_m = 0.0;
  double scatter_N = 0.0;  ///< standard deviation of F_s over cycles

  [[nodiscard]] double kinetic_friction_N() const { return f0_N + f1_N; }
  [[nodiscard]] double friction_difference_N() const { return static_friction_N - kinetic_friction_N(); }
  /// V times the period at the mean F_s; empty where there is no stick-slip.
  [[nodiscard]] std::optional<double> spacing_m(double speed_m_per_s) const;
};

/// Size of each recording; the study draws it, the timing fixes it.
struct Size {
  double cycles = 20.0;
  double samples_per_half_period = 25.0;
  std::size_t largest = 20000;
};

struct Sweep {
  std::uint64_t seed = 0;
  Truth truth;
  std::vector<slipfit::SweepEntry> entries;  ///< five speeds, each twice the one before
};

/// Every number follows from the seed. Two of three sweeps have alpha < 0 with alpha v_c from -0.3 to -3 (v_c: fastest
/// sliding of a slip); in the third 0 < alpha v_c < 0.3, where only the product f1 alpha can be seen. Every second one
/// has scattering static friction.
Sweep make_sweep(std::uint64_t seed, const std::optional<Size>& size = std::nullopt);

}  // namespace sweep_coverage
