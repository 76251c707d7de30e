#include "fit/problem/reduced_rows.hpp"

#include <catch2/catch.hpp>
#include <random>

using slipfit::fit::reduce_rows;
using slipfit::fit::RowMajor;

TEST_CASE("fit: reduced rows keep the sum of squares, the gradient and the normal matrix") {
  std::mt19937_64 random(71);
  std::normal_distribution<double> normal;
  constexpr int kRows = 117;
  constexpr int kColumns = 7;
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::NullaryExpr(kRows, kColumns, [&] { return normal(random); });
  jacobian.col(1) *= 1e6;
  jacobian.col(2).setZero();
  jacobian.col(4) = 2.0 * jacobian.col(3);  // no influence of its own
  jacobian.col(6) *= 1e-5;
  const Eigen::VectorXd residuals = Eigen::VectorXd::NullaryExpr(kRows, [&] { return 3.0 * normal(random); });

  RowMajor reduced(kColumns + 1, kColumns + 1);
  reduce_rows(jacobian, residuals, reduced);
  const RowMajor j = reduced.leftCols(kColumns);
  const Eigen::VectorXd r = reduced.col(kColumns);
  CHECK(r.squaredNorm() == Approx(residuals.squaredNorm()).epsilon(1e-13));
  // rounding of a sum of 117 products of two columns is far below 1e-13 of their lengths
  const Eigen::VectorXd lengths = jacobian.colwise().norm();
  const Eigen::MatrixXd normal_error = j.transpose() * j - jacobian.transpose() * jacobian;
  const Eigen::VectorXd gradient_error = j.transpose() * r - jacobian.transpose() * residuals;
  for (int a = 0; a < kColumns; ++a) {
    CHECK(std::abs(gradient_error[a]) <= 1e-13 * lengths[a] * residuals.norm());
    for (int b = 0; b < kColumns; ++b) CHECK(std::abs(normal_error(a, b)) <= 1e-13 * lengths[a] * lengths[b]);
  }
}
