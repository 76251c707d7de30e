#include "fit/reduced_rows.hpp"

namespace slipfit::fit {

const RowMajor& ReducedRows::reduce(const RowMajor& jacobian, const Eigen::VectorXd& residuals) {
  const Eigen::Index columns = jacobian.cols();
  products_.topLeftCorner(columns, columns).noalias() = jacobian.transpose() * jacobian;
  products_.row(columns).head(columns).noalias() = residuals.transpose() * jacobian;
  products_(columns, columns) = residuals.squaredNorm();
  // Pivots go by size: a parameter without influence ends as a row of zeros, not as a failure.
  ldlt_.compute(products_);
  reduced_.setIdentity(columns + 1, columns + 1);
  reduced_ = ldlt_.transpositionsP() * reduced_;
  reduced_ = ldlt_.matrixU() * reduced_;
  reduced_.array().colwise() *= ldlt_.vectorD().array().max(0.0).sqrt();
  return reduced_;
}

}  // namespace slipfit::fit
