#pragma once

#include <optional>
#include <vector>

#include "fit/inference/sweep_coordinates.hpp"

namespace slipfit::fit {

/// A first-order band wider than this says nothing.
inline constexpr double kWidestFactor = 2.0;

/// A fit without one recording.
struct LeftOut {
  Coordinates values;
  Spread spread;
};

/// A solution with its intervals.
struct SweepOutcome {
  const SweepSolution& solution;
  StaticFriction static_friction = StaticFriction::Constant;
  Coordinates values;  ///< zeta may be negative
  Spread spread;
  std::vector<std::optional<LeftOut>> left_out;  ///< one for each of the solution's recordings
  bool disagree = false;  ///< the covariance is widened by what leaving out each recording changes
};

/// Fits once without each recording.
SweepOutcome outcome_of(const SweepData& data, const SweepSolution& solution);

/// Root mean square of ln (spacing predicted without a recording / its own); no prediction counts as a factor of 2.
double left_out_error(const SweepOutcome& outcome);

}  // namespace slipfit::fit
