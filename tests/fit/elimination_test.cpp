#include "fit/problem/normals.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <random>

using namespace slipfit::fit;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr Index kCycles = 6;
constexpr Index kRows = 30;
constexpr Index kOwn = 2;
constexpr Index kCommon = 5;

/// Cycles that meet four of the five common parameters each: random lines of a least-squares problem, once as the
/// elimination takes them and once as one large matrix, own parameters first.
struct CyclesScene {
  explicit CyclesScene(bool joined) : all(MatrixXd::Zero(0, kCycles * kOwn + kCommon + 1)) {
    std::mt19937_64 random(71);
    std::normal_distribution<double> normal;
    const auto draw = [&] { return normal(random); };
    for (Index cycle = 0; cycle < kCycles; ++cycle) {
      MatrixXd lines = MatrixXd::NullaryExpr(kRows, 4 + kOwn + 1, draw);
      lines.col(0) *= 1e4;
      lines.col(5) *= 1e-2;
      const std::vector<Index>& columns = cycle < 3 ? even : odd;
      MatrixXd rows = MatrixXd::Zero(kRows, all.cols());
      for (Index i = 0; i < 4; ++i) rows.col(kCycles * kOwn + columns[static_cast<std::size_t>(i)]) = lines.col(i);
      rows.middleCols(cycle * kOwn, kOwn) = lines.middleCols(4, kOwn);
      rows.col(all.cols() - 1) = lines.col(6);
      append(rows);
      std::optional<RampResidual> ramp;
      if (joined && cycle + 1 < kCycles && cycle != 2) {
        ramp = RampResidual{draw(), {draw(), draw(), draw()}, {draw(), draw()}, {draw(), draw()}};
        append(row_of(*ramp, cycle, columns));
      }
      elimination.add_cycle(lines.transpose() * lines, columns, ramp ? &*ramp : nullptr);
    }
    MatrixXd alone = MatrixXd::Zero(1, all.cols());
    alone(0, kCycles * kOwn + 1) = 3.0;
    alone(0, all.cols() - 1) = 2.0;
    append(alone);
    RowMajor of_one = RowMajor::Zero(2, 2);
    of_one << 9.0, 6.0, 0.0, 4.0;
    elimination.add_cycle(of_one, one);
  }

  void append(const MatrixXd& rows) {
    all.conservativeResize(all.rows() + rows.rows(), all.cols());
    all.bottomRows(rows.rows()) = rows;
  }

  [[nodiscard]] MatrixXd row_of(const RampResidual& ramp, Index cycle, const std::vector<Index>& columns) const {
    MatrixXd row = MatrixXd::Zero(1, all.cols());
    for (Index i = 0; i < 2; ++i) {
      row(0, cycle * kOwn + i) = ramp.d_first[static_cast<std::size_t>(i)];
      row(0, (cycle + 1) * kOwn + i) = ramp.d_second[static_cast<std::size_t>(i)];
    }
    for (std::size_t i = 0; i < 3; ++i) row(0, kCycles * kOwn + columns[i]) = ramp.d_values[i];
    row(0, all.cols() - 1) = ramp.value;
    return row;
  }

  const std::vector<Index> even{0, 1, 2, 3};
  const std::vector<Index> odd{0, 1, 2, 4};
  const std::vector<Index> one{1};
  MatrixXd all;
  Elimination elimination{kCommon, 0.0};
};

}  // namespace

TEST_CASE("fit: eliminating the cycles' own parameters gives the least squares of all parameters") {
  const CyclesScene scene(GENERATE(false, true));
  const Index unknowns = kCycles * kOwn + kCommon;
  const MatrixXd jacobian = scene.all.leftCols(unknowns);
  const VectorXd residuals = scene.all.rightCols<1>();
  const VectorXd expected = -jacobian.colPivHouseholderQr().solve(residuals);

  RowMajor rows = scene.elimination.common();
  factorise(rows, scene.elimination.common_squares());
  const MatrixXd factor = rows.topLeftCorner(kCommon, kCommon).triangularView<Eigen::Upper>();
  const VectorXd common = -factor.triangularView<Eigen::Upper>().solve(rows.col(kCommon).head(kCommon));
  const RowMajor own = scene.elimination.own_steps(common, 1.0);
  // Condition 1e6 of the columns' scales, which the decomposition does not mix: rounding of some 1e-13 is left.
  for (Index i = 0; i < kCommon; ++i) CHECK(common(i) == Approx(expected(kCycles * kOwn + i)).epsilon(1e-10));
  for (Index i = 0; i < kCycles * kOwn; ++i) CHECK(own(i, 0) == Approx(expected(i)).epsilon(1e-10));
  const double least = (jacobian * expected + residuals).squaredNorm();
  CHECK(rows(kCommon, kCommon) == Approx(least).epsilon(1e-10));
  const double gains = scene.elimination.own_gain() + rows.col(kCommon).head(kCommon).squaredNorm();
  CHECK(residuals.squaredNorm() - gains == Approx(least).epsilon(1e-10));
}

TEST_CASE("fit: own parameters alone go to their least squares, or a share of the way") {
  const CyclesScene scene(GENERATE(false, true));
  const MatrixXd jacobian = scene.all.leftCols(kCycles * kOwn);
  const VectorXd expected = -jacobian.colPivHouseholderQr().solve(scene.all.rightCols<1>());
  const double share = GENERATE(1.0, 0.25);
  const RowMajor own = scene.elimination.own_steps(VectorXd::Zero(kCommon), share);
  for (Index i = 0; i < expected.size(); ++i) CHECK(own(i, 0) == Approx(share * expected(i)).epsilon(1e-10));
}

TEST_CASE("fit: common parameters that the cycles' own can replace are left where they are") {
  std::mt19937_64 random(73);
  std::normal_distribution<double> normal;
  const std::vector<Index> columns{0, 1};
  Elimination elimination(2, 0.0);
  for (Index cycle = 0; cycle < kCycles; ++cycle) {
    MatrixXd lines = MatrixXd::NullaryExpr(kRows, 2 + kOwn + 1, [&] { return normal(random); });
    lines.col(1) = lines.col(2) + 0.3 * lines.col(3);  // nothing of its own
    elimination.add_cycle(lines.transpose() * lines, columns);
  }
  RowMajor rows = elimination.common();
  factorise(rows, elimination.common_squares());
  CHECK(rows(0, 0) > 0.1);
  CHECK(rows.row(1).isZero(0.0));
}

TEST_CASE("fit: a parameter without influence of its own leaves a row of zeros and the rest as it is") {
  std::mt19937_64 random(72);
  std::normal_distribution<double> normal;
  MatrixXd lines = MatrixXd::NullaryExpr(117, 8, [&] { return normal(random); });
  lines.col(2).setZero();
  lines.col(4) = 2.0 * lines.col(3);
  const MatrixXd square = lines.transpose() * lines;
  RowMajor rows = square;
  factorise(rows, square.diagonal().head(7));
  CHECK(rows.row(2).isZero(0.0));
  CHECK(rows.row(4).tail(4).isZero(0.0));
  const MatrixXd factor = rows.topRows(7).triangularView<Eigen::Upper>();
  MatrixXd again = factor.transpose() * factor;
  again(7, 7) += rows(7, 7);
  // rounding of sums of 117 products is far below 1e-13 of the columns' lengths
  CHECK((again - square).cwiseAbs().maxCoeff() < 1e-13 * square.diagonal().maxCoeff());
}
