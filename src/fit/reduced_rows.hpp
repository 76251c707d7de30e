#pragma once

#include <Eigen/Dense>

namespace slipfit::fit {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A block's residuals r and Jacobian J as no more rows than they have columns: R' R = [J r]' [J r]. Sum of squares,
/// gradient and J' J stay what they are, so that a solver takes the same steps, but handles a handful of rows a block
/// in place of hundreds. The products square the condition number; so do the normal equations that the solver forms.
class ReducedRows {
 public:
  /// `columns`: of J.
  explicit ReducedRows(Eigen::Index columns) : products_(columns + 1, columns + 1), ldlt_(columns + 1) {}

  /// R, (columns + 1) x (columns + 1), the last column for r.
  const RowMajor& reduce(const RowMajor& jacobian, const Eigen::VectorXd& residuals);

 private:
  Eigen::MatrixXd products_;
  Eigen::LDLT<Eigen::MatrixXd, Eigen::Lower> ldlt_;
  RowMajor reduced_;
};

}  // namespace slipfit::fit
