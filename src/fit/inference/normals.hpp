#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <vector>

#include "fit/problem/common_columns.hpp"

namespace slipfit::fit {

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

Linearised linearise(const BlockFit& fit, std::size_t cycle);
std::vector<Normal> normals_of(const Problem& problem);

/// Those of the other recordings, numbered as their own problem has it. `all`: without one of its recordings it is
/// `others`.
std::vector<Normal> normals_without(const Problem& all, std::size_t recording, const std::vector<Normal>& normals,
                                    const Problem& others);

}  // namespace slipfit::fit
