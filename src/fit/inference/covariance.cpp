#include "fit/inference/covariance.hpp"

#include <Eigen/Sparse>
#include <limits>
#include <utility>

#include "fit/problem/ramp_residual.hpp"

namespace slipfit::fit {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

void add_scattered(const MatrixXd& part, const std::vector<Index>& columns, MatrixXd& sum) {
  for (Index i = 0; i < part.rows(); ++i) {
    for (Index j = 0; j < part.cols(); ++j) {
      sum(columns[static_cast<std::size_t>(i)], columns[static_cast<std::size_t>(j)]) += part(i, j);
    }
  }
}

/// The normal equations of a problem: own parameters cycle by cycle, then the common ones.
class SparseNormal {
 public:
  SparseNormal(const Problem& problem, const std::vector<Normal>& normals, const Held& held)
      : held_(held), common_(MatrixXd::Zero(CommonColumns(problem).size(), CommonColumns(problem).size())) {
    for (const Normal& normal : normals) first_common_ += normal.local.rows();
    for (const Normal& normal : normals) add_cycle(normal);
    hold_rows(common_, held);
    for (Index i = 0; i < common_.rows(); ++i) {
      for (Index j = 0; j < common_.cols(); ++j) add(first_common_ + i, first_common_ + j, common_(i, j));
    }
  }

  /// The ramp from a cycle of the only recording to the next.
  void add_ramp(const BlockFit& fit, std::size_t first) {
    const Parameters& p = fit.parameters;
    const RampResidual ramp =
        ramp_residual(fit, first, p.globals.data(), p.cycles[first].data(), p.cycles[first + 1].data());
    std::vector<std::pair<Index, double>> row;
    for (std::size_t i = 0; i < ramp.d_globals.size(); ++i) {
      if (!held_[i]) row.emplace_back(first_common_ + static_cast<Index>(i), ramp.d_globals[i]);
    }
    const auto local = static_cast<Index>(fit.model(0).local_parameters());
    const Index first_local = local * static_cast<Index>(first);
    for (Index i = 0; i < 2; ++i) {
      row.emplace_back(first_local + i, ramp.d_first[static_cast<std::size_t>(i)]);
      row.emplace_back(first_local + local + i, ramp.d_second[static_cast<std::size_t>(i)]);
    }
    for (const auto& [i, left] : row) {
      for (const auto& [j, right] : row) add(i, j, left * right);
    }
  }

  /// Derivatives of the coordinates with respect to all parameters, S, and H^-1 S.
  struct Seen {
    MatrixXd through;
    MatrixXd solved;  ///< not a number where H is singular
  };
  [[nodiscard]] Seen solve_for(const Selection& selection, double cycles) const {
    const Index size = first_common_ + common_.rows();
    Eigen::SparseMatrix<double> hessian(size, size);
    hessian.setFromTriplets(entries_.begin(), entries_.end());
    MatrixXd columns = MatrixXd::Zero(size, kCoordinates);
    const Index local = selection.local.rows();
    for (Index row = 0; local > 0 && row < first_common_; row += local)
      columns.middleRows(row, local) = selection.local / cycles;
    columns.bottomRows(common_.rows()) = selection.common;
    for (std::size_t i = 0; i < held_.size(); ++i) {
      if (held_[i]) columns.row(first_common_ + static_cast<Index>(i)).setZero();
    }
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(hessian);
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    if (factor.info() != Eigen::Success) return {columns, MatrixXd::Constant(size, kCoordinates, kNone)};
    return {columns, factor.solve(columns)};
  }

 private:
  void add_cycle(const Normal& n) {
    add_scattered(n.common, n.columns, common_);
    for (Index i = 0; i < n.local.rows(); ++i) {
      for (Index j = 0; j < n.local.cols(); ++j) add(next_local_ + i, next_local_ + j, n.local(i, j));
      for (Index j = 0; j < n.common.rows(); ++j) {
        const Index column = n.columns[static_cast<std::size_t>(j)];
        if (column < kGlobals && held_[static_cast<std::size_t>(column)]) continue;
        add(next_local_ + i, first_common_ + column, n.cross(j, i));
        add(first_common_ + column, next_local_ + i, n.cross(j, i));
      }
    }
    next_local_ += n.local.rows();
  }

  void add(Index row, Index column, double value) { entries_.emplace_back(row, column, value); }

  Held held_;
  MatrixXd common_;
  Index first_common_ = 0;
  Index next_local_ = 0;
  std::vector<Eigen::Triplet<double>> entries_;
};

}  // namespace

void hold_rows(MatrixXd& matrix, const Held& held) {
  for (std::size_t i = 0; i < held.size(); ++i) {
    if (!held[i]) continue;
    const auto row = static_cast<Index>(i);
    matrix.row(row).setZero();
    matrix.col(row).setZero();
    matrix(row, row) = 1.0;
  }
}

namespace {

SparseNormal::Seen solve_normal(const Problem& problem, const std::vector<Normal>& normals, const Selection& selection,
                                const SolveOptions& solved) {
  SparseNormal sum(problem, normals, held_in(problem, solved.held));
  const BlockFit& first = problem.recordings.front();
  for (std::size_t cycle = 0; solved.continuous && cycle + 1 < first.size(); ++cycle) {
    if (first.data(cycle).continuous_with_next) sum.add_ramp(first, cycle);
  }
  double cycles = 0.0;
  for (const BlockFit& recording : problem.recordings) cycles += static_cast<double>(recording.size());
  return sum.solve_for(selection, cycles);
}

}  // namespace

CoordinateMatrix white_covariance(const Problem& problem, const std::vector<Normal>& normals,
                                  const Selection& selection, const SolveOptions& solved) {
  const SparseNormal::Seen seen = solve_normal(problem, normals, selection, solved);
  return seen.through.transpose() * seen.solved;
}

std::vector<MatrixXd> influences_of(const BlockFit& fit, const Selection& selection, const SolveOptions& solved) {
  const Problem problem{{&fit, 1}};
  const MatrixXd moves = solve_normal(problem, normals_of(problem), selection, solved).solved;
  const auto local = static_cast<Index>(fit.model(0).local_parameters());
  const MatrixXd common = moves.bottomRows(moves.rows() - local * static_cast<Index>(fit.size()));
  std::vector<MatrixXd> influences;
  for (std::size_t cycle = 0; cycle < fit.size(); ++cycle) {
    const Linearised lines = linearise(fit, cycle);
    const auto own = moves.middleRows(local * static_cast<Index>(cycle), local);
    influences.emplace_back(-lines.common * common - lines.local * own);
  }
  return influences;
}

namespace {

/// A unit of the jackknife (a cycle or a steady recording), its own parameters eliminated.
struct Unit {
  MatrixXd hessian;   ///< of the common parameters that it has
  VectorXd score;     ///< of all common parameters
  MatrixXd response;  ///< of the cycle's own parameters to the common ones; empty where no coordinate needs it
};

Unit eliminate(const Normal& n, Index common, Index local, const Held& held) {
  MatrixXd follow = MatrixXd::Zero(n.local.rows(), n.common.rows());
  if (n.local.rows() > 0) follow = -n.local.ldlt().solve(n.cross.transpose());
  const VectorXd score = n.score + follow.transpose() * n.local_score;
  Unit unit{n.common + n.cross * follow, VectorXd::Zero(common), MatrixXd::Zero(local, common)};
  for (std::size_t i = 0; i < n.columns.size(); ++i) {
    const Index column = n.columns[i];
    const bool is_held = column < kGlobals && held[static_cast<std::size_t>(column)];
    if (!is_held) unit.score(column) += score(static_cast<Index>(i));
    if (local > 0) unit.response.col(column) += follow.col(static_cast<Index>(i));
  }
  return unit;
}

}  // namespace

NewtonStep newton_step(const Problem& problem, const std::vector<Normal>& normals, const Held& all_held) {
  const Held held = held_in(problem, all_held);
  const Index common = CommonColumns(problem).size();
  MatrixXd hessian = MatrixXd::Zero(common, common);
  VectorXd gradient = VectorXd::Zero(common);
  NewtonStep result;
  for (const Normal& normal : normals) {
    const Unit unit = eliminate(normal, common, 0, held);
    const double norm = normal.residuals.norm();
    const bool is_cycle = normal.local.rows() > 0;
    const HuberWeight weight = is_cycle ? huber_weight(norm, static_cast<std::size_t>(normal.residuals.size()))
                                        : HuberWeight{1.0, norm * norm};
    add_scattered(weight.factor * unit.hessian, normal.columns, hessian);
    gradient += weight.factor * unit.score;
    result.sum_of_squares += weight.sum;
  }
  hold_rows(hessian, held);
  result.step = -hessian.ldlt().solve(gradient);
  result.gain = -gradient.dot(result.step);
  result.sum_of_squares -= result.gain;
  return result;
}

CoordinateMatrix jackknife_covariance(const Problem& problem, const std::vector<Normal>& normals,
                                      const Selection& selection, const Held& all_held) {
  const Held held = held_in(problem, all_held);
  const Index common = CommonColumns(problem).size();
  const Index local = selection.local.rows();
  const auto local_of = [&](std::size_t unit) -> Eigen::Map<const VectorXd> {
    return {local > 0 ? problem.recordings.front().parameters.cycles[unit].data() : nullptr, local};
  };
  MatrixXd hessian = MatrixXd::Zero(common, common);
  MatrixXd response = MatrixXd::Zero(local, common);
  VectorXd locals = VectorXd::Zero(local);
  std::vector<Unit> units;
  for (const Normal& normal : normals) {
    locals += local_of(units.size());
    units.push_back(eliminate(normal, common, local, held));
    add_scattered(units.back().hessian, normal.columns, hessian);
    response += units.back().response;
  }
  const double others = static_cast<double>(units.size()) - 1.0;
  MatrixXd replicates(static_cast<Index>(units.size()), Index{kCoordinates});
  for (std::size_t i = 0; i < units.size(); ++i) {
    MatrixXd remaining = hessian;
    add_scattered(-units[i].hessian, normals[i].columns, remaining);
    hold_rows(remaining, held);
    const VectorXd step = remaining.ldlt().solve(units[i].score);  // without r_i'r_i the gradient is -score_i
    const VectorXd mean_local = (locals - local_of(i) + (response - units[i].response) * step) / others;
    replicates.row(static_cast<Index>(i)) = selection.common.transpose() * step;
    if (local > 0) replicates.row(static_cast<Index>(i)) += selection.local.transpose() * mean_local;
  }
  const MatrixXd centred = replicates.rowwise() - replicates.colwise().mean();
  return others / static_cast<double>(units.size()) * centred.transpose() * centred;
}

CoordinateMatrix given(const CoordinateMatrix& covariance, Coordinate held) {
  const double variance = covariance(held, held);
  if (!(variance > 0.0)) return covariance;
  return covariance - covariance.col(held) * covariance.row(held) / variance;
}

}  // namespace slipfit::fit
