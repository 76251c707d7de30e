#include "fit/inference/covariance.hpp"

#include <Eigen/Sparse>
#include <limits>
#include <utility>

#include "fit/problem/ramp_residual.hpp"

namespace slipfit::fit {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

CommonColumns::CommonColumns(const Problem& problem) {
  const std::size_t count = problem.recordings.size();
  const auto globals = static_cast<Index>(problem.recordings.front().model(0).globals());
  size_ = globals;
  const auto add = [&](std::vector<Index>& columns, auto&& width_of, bool shared) {
    for (std::size_t r = 0; r < count; ++r) {
      const Index width = width_of(problem.recordings[r]);
      const bool again = shared && r > 0;
      columns.push_back(again ? columns.front() : size_);
      if (!again) size_ += width;
    }
  };
  const auto constants = [](const BlockFit& r) { return Index{r.model(0).has_constant()}; };
  const auto populations = [](const BlockFit& r) { return Index{r.scales().population.has_value()}; };
  const auto drifts = [](const BlockFit& r) { return static_cast<Index>(r.model(0).drift_parameters()); };
  add(levels_, constants, problem.sweep.sharing.level);
  add(differences_, populations, problem.sweep.sharing.difference);
  add(drifts_, drifts, false);
  for (std::size_t r = 0; r < count; ++r) {
    const BlockFit& recording = problem.recordings[r];
    of_.emplace_back();
    for (Index i = 0; i < globals; ++i) of_.back().push_back(i);
    if (populations(recording) > 0) of_.back().push_back(differences_[r]);
    if (constants(recording) > 0) of_.back().push_back(levels_[r]);
    for (Index i = 0; i < drifts(recording); ++i) of_.back().push_back(drifts_[r] + i);
  }
}

Linearised linearise(const BlockFit& fit, std::size_t cycle) {
  const CycleModel& model = fit.model(cycle);
  const auto rows = static_cast<Index>(model.residuals());
  Linearised result;
  result.residuals.resize(rows);
  MatrixXd jacobian(rows, static_cast<Index>(model.columns()));
  model.evaluate(fit.values(cycle), result.residuals.data(), jacobian.data());
  result.common = jacobian.leftCols(static_cast<Index>(model.common_parameters()));
  result.local = jacobian.rightCols(static_cast<Index>(model.local_parameters()));
  return result;
}

namespace {

Normal normal_of(Linearised lines, std::vector<Index> columns) {
  Normal normal;
  normal.columns = std::move(columns);
  normal.common = lines.common.transpose() * lines.common;
  normal.cross = lines.common.transpose() * lines.local;
  normal.local = lines.local.transpose() * lines.local;
  normal.score = lines.common.transpose() * lines.residuals;
  normal.local_score = lines.local.transpose() * lines.residuals;
  normal.residuals = std::move(lines.residuals);
  return normal;
}

/// A row for the globals and the level that all recordings share.
Normal normal_of(const SteadyRun& run, const Problem& problem, const CommonColumns& columns) {
  const Parameters& parameters = problem.recordings.front().parameters;
  const SteadyResidual steady = steady_residual(run, problem.sweep.units, problem.recordings.front().scales().law,
                                                parameters.globals.data(), parameters.level.front());
  const auto globals = static_cast<Index>(problem.recordings.front().model(0).globals());
  std::vector<Index> of_row(columns.of(0).begin(), columns.of(0).begin() + globals);
  of_row.push_back(columns.level(0));
  Linearised lines{VectorXd::Constant(1, steady.value), MatrixXd(1, globals + 1), MatrixXd(1, 0)};
  for (Index i = 0; i < globals; ++i) lines.common(0, i) = steady.by_global[static_cast<std::size_t>(i)];
  lines.common(0, globals) = steady.by_level;
  return normal_of(std::move(lines), std::move(of_row));
}

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

  [[nodiscard]] CoordinateMatrix inverse_through(const Selection& selection, double cycles) const {
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
    if (factor.info() != Eigen::Success) return CoordinateMatrix::Constant(kNone);
    return columns.transpose() * factor.solve(columns);
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

/// Only the globals that the law has can be held.
Held held_in(const Problem& problem, Held held) {
  for (std::size_t i = problem.recordings.front().model(0).globals(); i < held.size(); ++i) held[i] = false;
  return held;
}

}  // namespace

std::vector<Normal> normals_of(const Problem& problem) {
  const CommonColumns columns(problem);
  std::vector<Normal> normals;
  for (std::size_t r = 0; r < problem.recordings.size(); ++r) {
    const BlockFit& recording = problem.recordings[r];
    for (std::size_t c = 0; c < recording.size(); ++c) {
      normals.push_back(normal_of(linearise(recording, c), columns.of(r)));
    }
  }
  for (std::size_t i = 0; problem.sweep.sharing.level && i < problem.sweep.steady.size(); ++i) {
    normals.push_back(normal_of(problem.sweep.steady[i], problem, columns));
  }
  return normals;
}

void hold_rows(MatrixXd& matrix, const Held& held) {
  for (std::size_t i = 0; i < held.size(); ++i) {
    if (!held[i]) continue;
    const auto row = static_cast<Index>(i);
    matrix.row(row).setZero();
    matrix.col(row).setZero();
    matrix(row, row) = 1.0;
  }
}

CoordinateMatrix white_covariance(const Problem& problem, const std::vector<Normal>& normals,
                                  const Selection& selection, const SolveOptions& solved) {
  SparseNormal sum(problem, normals, held_in(problem, solved.held));
  const BlockFit& first = problem.recordings.front();
  for (std::size_t cycle = 0; solved.continuous && cycle + 1 < first.size(); ++cycle) {
    if (first.data(cycle).continuous_with_next) sum.add_ramp(first, cycle);
  }
  double cycles = 0.0;
  for (const BlockFit& recording : problem.recordings) cycles += static_cast<double>(recording.size());
  return sum.inverse_through(selection, cycles);
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
