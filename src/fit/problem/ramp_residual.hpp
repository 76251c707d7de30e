#pragma once

#include <array>

#include "fit/problem/block_fit.hpp"

namespace slipfit::fit {

/// The ramp from the end of one slip to the onset of the next is one line: residual (kV (t2 - t1) + u I - A2) and its
/// derivatives with respect to ln k, ln w_n and zeta, first own (2), second own (2), scaled by Scales::noise *
/// kRampTolerance. Coulomb friction.
struct RampResidual {
  double value = 0.0;
  std::array<double, 3> d_values{};
  std::array<double, 2> d_first{};
  std::array<double, 2> d_second{};
};
RampResidual ramp_residual(const BlockFit& fit, std::size_t first, const Coordinates& values, const double* local_first,
                           const double* local_second);

/// The tolerance counts in units of the noise. It is small enough to hold the ramp together (a ramp's mean is known to
/// noise / sqrt(samples)) and large enough to keep the normal equations well conditioned.
inline constexpr double kRampTolerance = 0.01;

}  // namespace slipfit::fit
