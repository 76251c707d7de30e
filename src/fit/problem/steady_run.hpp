#pragma once

#include "fit/coordinates.hpp"

namespace slipfit::fit {

/// A recording of a sweep that slides steadily: its mean force is F_k(V).
struct SteadyRun {
  double speed_m_per_s = 0.0;
  double load = 1.0;
  double mean_force = 0.0;
  double standard_error = 0.0;
};

/// Residual of a steady recording and its derivatives with respect to the coordinates and the shared level. `units` of
/// the sweep.
struct SteadyResidual {
  double value = 0.0;
  Coordinates by_value = Coordinates::Zero();
  double by_level = 0.0;
};
SteadyResidual steady_residual(const SteadyRun& run, const Units& units, FrictionLaw law, const Coordinates& values,
                               double level);

}  // namespace slipfit::fit
