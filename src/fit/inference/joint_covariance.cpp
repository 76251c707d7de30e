#include "fit/inference/joint_covariance.hpp"

#include <algorithm>
#include <vector>

#include "fit/inference/covariance.hpp"

namespace slipfit::fit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<Index> held_rows(const JointHeld& held) {
  std::vector<Index> rows;
  for (std::size_t i = 0; i < held.size(); ++i) {
    if (held[i]) rows.push_back(static_cast<Index>(i));
  }
  return rows;
}

MatrixXd inverse(const MatrixXd& matrix) {
  return matrix.ldlt().solve(MatrixXd::Identity(matrix.rows(), matrix.cols()));
}

}  // namespace

JointCovariance covariance_of(const SweepData& data, const JointSolution& solution) {
  const std::vector<JointProblem::Normal> normals = solution.problem->normals();
  const auto columns = static_cast<Index>(solution.problem->columns());
  MatrixXd total = MatrixXd::Zero(columns, columns);
  for (const JointProblem::Normal& normal : normals) total += normal.matrix;
  const std::vector<Index> held = held_rows(solution.held);
  JointCovariance result;
  result.from_cycles = std::any_of(data.fitted.begin(), data.fitted.end(),
                                   [&](std::size_t i) { return data.single[i]->uncertainty.from_cycles; });
  if (!result.from_cycles) {
    hold_rows(total, held);
    const double variance = std::max(1.0, solution.chi2 / solution.degrees_of_freedom);
    result.matrix = variance * inverse(total);
    result.degrees_of_freedom = static_cast<double>(solution.problem->cycle_count());
  } else {
    // Delete-one-cycle jackknife, one Newton step each (CR3).
    const auto count = static_cast<double>(normals.size());
    MatrixXd steps(static_cast<Index>(normals.size()), columns);
    for (std::size_t i = 0; i < normals.size(); ++i) {
      MatrixXd remaining = total - normals[i].matrix;
      VectorXd score = normals[i].score;
      hold_rows(remaining, held);
      for (const Index row : held) score(row) = 0.0;
      steps.row(static_cast<Index>(i)) = remaining.ldlt().solve(score).transpose();
    }
    const MatrixXd centred = steps.rowwise() - steps.colwise().mean();
    result.matrix = (count - 1.0) / count * centred.transpose() * centred;
    result.degrees_of_freedom = std::max(1.0, count - 1.0);
  }
  for (const Index row : held) {
    result.matrix.row(row).setZero();
    result.matrix.col(row).setZero();
  }
  return result;
}

}  // namespace slipfit::fit
