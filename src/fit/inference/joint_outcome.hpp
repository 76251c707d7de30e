#pragma once

#include <optional>
#include <vector>

#include "fit/inference/joint_quantities.hpp"

namespace slipfit::fit {

/// A first-order band wider than this says nothing.
inline constexpr double kWidestFactor = 2.0;

/// Fits without one recording each: their predictions, and how much the parameters move.
struct LeftOut {
  struct One {
    SweepVector values;
    SweepMatrix covariance;
    double degrees_of_freedom = 1.0;
  };
  std::vector<std::optional<One>> each;  ///< in the order of SweepData::fitted

  /// Delete-one-recording jackknife.
  [[nodiscard]] SweepMatrix covariance() const;
  [[nodiscard]] double count() const;
};

/// A solution with the intervals that it deserves.
struct Outcome {
  const JointSolution& solution;
  StaticFriction static_friction = StaticFriction::Constant;
  SweepVector values;
  SweepMatrix covariance;
  double degrees_of_freedom = 1.0;
  LeftOut left_out;
  RateProfile profile{};
  bool disagree = false;  ///< the covariance is widened by what leaving out each recording changes
};

/// Fits once without each recording.
Outcome weigh(const SweepData& data, const JointSolution& solution);

/// Root mean square of ln (spacing predicted without a recording / its own); no prediction counts as a factor of 2.
double left_out_error(const SweepData& data, const Outcome& outcome);

}  // namespace slipfit::fit
