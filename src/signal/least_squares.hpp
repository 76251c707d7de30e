#pragma once

#include <Eigen/Core>

namespace slipfit::signal {

/// Returns the coefficients of the columns whose sum is nearest to the values, by a QR decomposition with pivoting.
/// Compiled once: the decomposition takes the compiler longer than most files that need it.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& columns, const Eigen::VectorXd& values);

}  // namespace slipfit::signal
