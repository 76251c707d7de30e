#pragma once

#include <Eigen/Dense>

namespace slipfit::fit {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Fewer rows that say the same of a block's Jacobian J and residuals r: R with R' R = [J r]' [J r], upper triangular,
/// the last column for r. Sum of squares, gradient and J' J stay what they are, so that a solver takes the same steps,
/// but handles one row a column in place of hundreds. The products square the condition number; so do the normal
/// equations that the solver forms. `reduced`: of the right size, overwritten.
void reduce_rows(const Eigen::Ref<const Eigen::MatrixXd>& jacobian, const Eigen::Ref<const Eigen::VectorXd>& residuals,
                 RowMajor& reduced);

}  // namespace slipfit::fit
