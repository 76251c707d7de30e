#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <vector>

#include "fit/coordinates.hpp"
#include "fit/problem/solve.hpp"

namespace slipfit::fit {

/// Columns of what the cycles of a problem have in common: globals, then levels, differences and drifts of the
/// recordings, those that there are; shared ones once.
class CommonColumns {
 public:
  explicit CommonColumns(const Problem& problem);

  [[nodiscard]] Eigen::Index size() const { return size_; }
  [[nodiscard]] Eigen::Index level(std::size_t recording) const { return levels_[recording]; }
  [[nodiscard]] Eigen::Index difference(std::size_t recording) const { return differences_[recording]; }
  [[nodiscard]] Eigen::Index drift(std::size_t recording) const { return drifts_[recording]; }
  /// Of the Jacobian of a recording's cycles, in its order.
  [[nodiscard]] const std::vector<Eigen::Index>& of(std::size_t recording) const { return of_[recording]; }

 private:
  Eigen::Index size_ = 0;
  std::vector<Eigen::Index> levels_, differences_, drifts_;
  std::vector<std::vector<Eigen::Index>> of_;
};

/// One cycle's residuals r and their derivatives J at the solution; the samples around the slip come first.
struct Linearised {
  Eigen::VectorXd residuals;
  Eigen::MatrixXd common;
  Eigen::MatrixXd local;
};

/// One cycle's (or steady recording's, without own parameters) part of the normal equations.
struct Normal {
  std::vector<Eigen::Index> columns;  ///< of `common` among the problem's
  Eigen::MatrixXd common;             ///< common x common
  Eigen::MatrixXd cross;              ///< common x own
  Eigen::MatrixXd local;              ///< own x own
  Eigen::VectorXd score;              ///< J' r for common
  Eigen::VectorXd local_score;
  Eigen::VectorXd residuals;
};

/// Derivatives of the coordinates with respect to the common parameters and to the mean of the cycles' own ones.
struct Selection {
  Eigen::MatrixXd common;  ///< common x coordinates
  Eigen::MatrixXd local;   ///< own x coordinates; empty where all are 0
};

Linearised linearise(const BlockFit& fit, std::size_t cycle);
std::vector<Normal> normals_of(const Problem& problem);

/// Held globals: their rows and columns of a normal matrix become those of exactly known ones.
void hold_rows(Eigen::MatrixXd& matrix, const Held& held);

/// Inverse normal matrix seen through the coordinates: S' H^-1 S, with the ramps' coupling of neighbours where
/// continuous. Not a number where H is singular.
CoordinateMatrix white_covariance(const Problem& problem, const std::vector<Normal>& normals,
                                  const Selection& selection, const SolveOptions& solved);

/// Delete-one-cycle jackknife of the coordinates, one Newton step each: CR3.
CoordinateMatrix jackknife_covariance(const Problem& problem, const std::vector<Normal>& normals,
                                      const Selection& selection, const Held& held);

/// What is left of a covariance where one coordinate is held.
CoordinateMatrix given(const CoordinateMatrix& covariance, Coordinate held);

}  // namespace slipfit::fit
