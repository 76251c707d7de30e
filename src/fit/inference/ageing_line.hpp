#pragma once

#include <Eigen/Dense>

#include "fit/selection/sweep_solution.hpp"
#include "slipfit/fit/result.hpp"

namespace slipfit::fit {

/// Of a sweep: static friction is constant, or ages as its recordings say.
enum class StaticFriction { Constant, Ages };

/// F_s - F_k(0+) / Units::force of each recording.
Eigen::VectorXd differences_of(const SweepSolution& solution);

/// F_s - F_k(0+) = D + rate ln(stick / Units::stick_s) through the recordings' own values. At one speed a larger
/// F_s - F_k makes a longer stick, ageing or not: what moves the stick time here is the driving speed (instrumental
/// variable ln V).
struct AgeingLine {
  Eigen::VectorXd difference_weights, rate_weights;  ///< of the recordings' own F_s - F_k(0+)
  double residual_variance = 0.0;                    ///< of one recording around the line
  bool explains = false;                             ///< what is left is within the recordings' own errors
};

/// Needs two recordings or more with each its own F_s - F_k(0+), and at different speeds.
AgeingLine ageing_line(const SweepSolution& solution);

/// Ages where recordings have each their own static friction and it falls with ln V: along a line within their own
/// errors, or by more than chance (fewer than one sweep of 100 without ageing is taken for one that ages).
StaticFriction static_friction_of(const SweepSolution& solution);

/// What the sweep tells of static friction beyond its speeds. Where the recordings differ, the trend of
/// ln(F_s - F_k(0+)) over ln V may end or double. Where they share one, the trend that they could hide, by the evidence
/// that there is none (Schwarz's criterion).
SpeedReach reach_of(const SweepSolution& solution);

}  // namespace slipfit::fit
