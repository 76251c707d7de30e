#include "fit/problem/reduced_rows.hpp"

#include <cmath>

namespace slipfit::fit {

void reduce_rows(const Eigen::Ref<const Eigen::MatrixXd>& jacobian, const Eigen::Ref<const Eigen::VectorXd>& residuals,
                 RowMajor& reduced) {
  const Eigen::Index columns = jacobian.cols();
  reduced.setZero();
  for (Eigen::Index a = 0; a < columns; ++a) {
    for (Eigen::Index b = a; b < columns; ++b) reduced(a, b) = jacobian.col(a).dot(jacobian.col(b));
    reduced(a, columns) = jacobian.col(a).dot(residuals);
  }
  reduced(columns, columns) = residuals.squaredNorm();
  // Cholesky's decomposition in place. What a column adds to those before it may be nothing but rounding: a parameter
  // without influence of its own leaves a row of zeros.
  constexpr double kRounding = 1e-15;
  for (Eigen::Index k = 0; k <= columns; ++k) {
    const double whole = reduced(k, k);
    auto row = reduced.row(k).tail(columns + 1 - k);
    for (Eigen::Index i = 0; i < k; ++i) row -= reduced(i, k) * reduced.row(i).tail(columns + 1 - k);
    if (reduced(k, k) > kRounding * whole) {
      row /= std::sqrt(reduced(k, k));
    } else {
      row.setZero();
    }
  }
}

}  // namespace slipfit::fit
