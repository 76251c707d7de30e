#pragma once

#include <Eigen/Dense>
#include <vector>

#include "fit/coordinates.hpp"
#include "fit/problem/normals.hpp"
#include "fit/problem/solve.hpp"

namespace slipfit::fit {

/// Says how a solution was found, as SolveOptions.
struct Solved {
  Held held{};
  bool continuous = false;
};

/// Derivatives of the coordinates with respect to the common parameters and to the mean of the cycles' own ones.
struct Selection {
  Eigen::MatrixXd common;  ///< common x coordinates
  Eigen::MatrixXd local;   ///< own x coordinates; empty where all are 0
};

/// A step of the common parameters to the least sum of squares, the cycles' own parameters following; cycles far worse
/// than the others count linearly (huber_weight).
struct NewtonStep {
  Eigen::VectorXd step;
  double sum_of_squares = 0.0;  ///< after the step
  double gain = 0.0;            ///< of the step
};
NewtonStep newton_step(const Problem& problem, const std::vector<Normal>& normals, const Held& held);

/// Steps of the common parameters to the least sums of squares, a column for each of the `sides`; those of the
/// columns `held` stay.
/// `reduced`: as Elimination::common. Not a number where it is singular.
Eigen::MatrixXd common_steps(const RowMajor& reduced, Eigen::Index sides, const std::vector<Eigen::Index>& held);

/// Returns the move of the coordinates of a recording with steps of the common parameters (common_steps), the cycles'
/// own following, for the first of the sides.
Coordinates move_of(const Selection& selection, const Elimination& elimination, const Eigen::MatrixXd& steps);

/// Inverse normal matrix seen through the coordinates: S' H^-1 S, with the ramps' coupling of neighbours where
/// continuous. Not a number where H is singular.
CoordinateMatrix white_covariance(const Problem& problem, const std::vector<Normal>& normals,
                                  const Selection& selection, const Solved& solved);

/// Returns the moves of the coordinates by the residuals of each cycle of a recording, to first order: residuals x
/// coordinates. They are not a number where H is singular.
std::vector<Eigen::MatrixXd> influences_of(const BlockFit& fit, const Selection& selection, const Solved& solved);

/// Delete-one-cycle jackknife of the coordinates, one Newton step each: CR3.
CoordinateMatrix jackknife_covariance(const Problem& problem, const std::vector<Normal>& normals,
                                      const Selection& selection, const Held& held);

/// Returns the covariance that remains when one coordinate is held.
CoordinateMatrix given(const CoordinateMatrix& covariance, Coordinate held);

}  // namespace slipfit::fit
