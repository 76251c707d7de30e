#include "fit/problem/held_values.hpp"

namespace slipfit::fit {

HeldValues fixed_values(const FitOptions& options) {
  HeldValues held;
  for (const auto& [name, value] : options.fixed) {
    if (name == "stiffness_N_per_m") held.stiffness_N_per_m = value;
    if (name == "natural_frequency_rad_per_s") held.omega_rad_per_s = value;
    if (name == "damping_ratio") held.damping_ratio = value;
  }
  return held;
}

}  // namespace slipfit::fit
