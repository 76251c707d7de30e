#pragma once

#include <Eigen/Dense>

#include "fit/selection/joint_solution.hpp"

namespace slipfit::fit {

/// Covariance of JointProblem's columns: white noise, or the jackknife over cycles where residuals correlate.
struct JointCovariance {
  Eigen::MatrixXd matrix;
  double degrees_of_freedom = 1.0;
  bool from_cycles = false;
};
JointCovariance covariance_of(const SweepData& data, const JointSolution& solution);

}  // namespace slipfit::fit
