#pragma once

#include <optional>

#include "slipfit/fit/fit.hpp"

namespace slipfit::fit {

/// Values (natural parameters, zeta itself) at which shared parameters are held.
struct HeldValues {
  std::optional<double> stiffness_N_per_m;
  std::optional<double> omega_rad_per_s;
  std::optional<double> damping_ratio;
};

/// The shared parameters that the user holds by name; the tier is not asked.
HeldValues fixed_values(const FitOptions& options);

}  // namespace slipfit::fit
