#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <vector>

#include "fit/problem/block_fit.hpp"

namespace slipfit::fit {

/// One cycle's residuals r and their derivatives J at the solution; the samples around the slip come first.
struct Linearised {
  Eigen::VectorXd residuals;
  Eigen::MatrixXd common;  // rows x common
  Eigen::MatrixXd own;     // rows x own
};

/// One cycle's part of the normal equations; `common` are the shared parameters and the level's columns.
struct Normal {
  Eigen::MatrixXd common;  // common x common
  Eigen::MatrixXd cross;   // common x own
  Eigen::MatrixXd own;     // own x own
  Eigen::VectorXd score;   // J' r for common
  Eigen::VectorXd own_score;
  Eigen::VectorXd residuals;
};

/// How the quantities hang on the common parameters and on each cycle's own ones.
struct Selection {
  Eigen::MatrixXd common;  // common x quantities
  Eigen::MatrixXd own;     // own x quantities, the same for every cycle: weight of one cycle in the mean
};

Eigen::Index common_size(const BlockFit& fit);
Eigen::Index own_size(const BlockFit& fit);

Linearised linearise(const BlockFit& fit, std::size_t cycle);
Normal normal_of(const BlockFit& fit, std::size_t cycle);

/// Means over all cycles of the fit.
Selection select(const BlockFit& fit);

/// Rows of the common parameters that are held.
std::vector<Eigen::Index> held_rows(const Held& held);

/// Held parameters: their rows and columns of a normal matrix become those of exactly known ones.
void hold_rows(Eigen::MatrixXd& matrix, const std::vector<Eigen::Index>& rows);

/// Inverse normal matrix seen through the quantities: S' H^-1 S, with the ramps' coupling of neighbours where
/// continuous.
Eigen::MatrixXd white_covariance(const BlockFit& fit, const std::vector<Normal>& normals, const Held& held,
                                 bool continuous);

/// Delete-one-cycle jackknife of the quantities, one Newton step each: CR3.
Eigen::MatrixXd jackknife_covariance(const BlockFit& fit, const std::vector<Normal>& normals, const Held& held);

}  // namespace slipfit::fit
