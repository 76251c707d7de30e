#include "fit/inference/covariance.hpp"

#include <Eigen/Sparse>
#include <algorithm>
#include <limits>
#include <utility>

#include "fit/inference/uncertainty.hpp"

namespace slipfit::fit {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

Index common_size(const BlockFit& fit) {
  return static_cast<Index>(kShared + fit.level().columns());
}
Index own_size(const BlockFit& fit) {
  return fit.level().per_cycle ? 3 : 2;
}

Linearised linearise(const BlockFit& fit, std::size_t cycle) {
  const CycleModel& model = fit.model(cycle);
  const auto rows = static_cast<Index>(model.residuals());
  Linearised result;
  result.residuals.resize(rows);
  MatrixXd jacobian(rows, static_cast<Index>(model.columns()));
  model.evaluate(fit.parameters.shared.data(), fit.level_data(), fit.parameters.cycles[cycle].data(),
                 result.residuals.data(), jacobian.data());
  result.common = jacobian.leftCols(common_size(fit));
  result.own = jacobian.rightCols(own_size(fit));
  return result;
}

Normal normal_of(const BlockFit& fit, std::size_t cycle) {
  Linearised lines = linearise(fit, cycle);
  Normal normal;
  normal.common = lines.common.transpose() * lines.common;
  normal.cross = lines.common.transpose() * lines.own;
  normal.own = lines.own.transpose() * lines.own;
  normal.score = lines.common.transpose() * lines.residuals;
  normal.own_score = lines.own.transpose() * lines.residuals;
  normal.residuals = std::move(lines.residuals);
  return normal;
}

Selection select(const BlockFit& fit) {
  Selection selection{MatrixXd::Zero(common_size(fit), kQuantities), MatrixXd::Zero(own_size(fit), kQuantities)};
  for (Index i = 0; i < static_cast<Index>(kShared); ++i) selection.common(i, i) = 1.0;
  const double share = 1.0 / static_cast<double>(fit.size());
  selection.own(1, kOnsetForce) = share;
  if (fit.level().per_cycle) {
    selection.own(2, kLevel) = share;
    return selection;
  }
  std::vector<double> values(fit.level().terms);
  std::vector<double> slopes(fit.level().terms);
  for (std::size_t cycle = 0; cycle < fit.size(); ++cycle) {
    const Scales& scales = fit.scales();
    const double x =
        2.0 * (fit.reference_s(cycle) - scales.time_begin_s) / (scales.time_end_s - scales.time_begin_s) - 1.0;
    legendre(x, fit.level().terms, values.data(), slopes.data());
    for (std::size_t i = 0; i < values.size(); ++i) {
      selection.common(static_cast<Index>(kShared + i), kLevel) += share * values[i];
    }
  }
  return selection;
}

std::vector<Index> held_rows(const Held& held) {
  std::vector<Index> rows;
  if (held.stiffness) rows.push_back(0);
  if (held.frequency) rows.push_back(1);
  if (held.damping) rows.push_back(2);
  return rows;
}

void hold_rows(MatrixXd& matrix, const std::vector<Index>& rows) {
  for (const Index row : rows) {
    matrix.row(row).setZero();
    matrix.col(row).setZero();
    matrix(row, row) = 1.0;
  }
}

namespace {

/// The normal equations of all cycles: own parameters cycle by cycle, then the common ones.
class SparseNormal {
 public:
  SparseNormal(const BlockFit& fit, const Held& held)
      : fit_(fit),
        own_(own_size(fit)),
        common_(common_size(fit)),
        first_common_(own_ * static_cast<Index>(fit.size())),
        held_(held_rows(held)) {
    for (const Index i : held_) add(first_common_ + i, first_common_ + i, 1.0);
  }

  void add_cycle(std::size_t cycle, const Normal& n) {
    const Index first_own = own_ * static_cast<Index>(cycle);
    for (Index i = 0; i < own_; ++i) {
      for (Index j = 0; j < own_; ++j) add(first_own + i, first_own + j, n.own(i, j));
      for (Index j = 0; j < common_; ++j) {
        if (is_held(j)) continue;
        add(first_own + i, first_common_ + j, n.cross(j, i));
        add(first_common_ + j, first_own + i, n.cross(j, i));
      }
    }
    for (Index i = 0; i < common_; ++i) {
      for (Index j = 0; j < common_; ++j) {
        if (!is_held(i) && !is_held(j)) add(first_common_ + i, first_common_ + j, n.common(i, j));
      }
    }
  }

  /// The ramp from a cycle to the next.
  void add_ramp(std::size_t first) {
    const RampResidual ramp =
        ramp_residual(fit_, first, fit_.parameters.shared.data(), fit_.parameters.cycles[first].data(),
                      fit_.parameters.cycles[first + 1].data());
    std::vector<std::pair<Index, double>> row;
    for (Index i = 0; i < 3; ++i) {
      if (!is_held(i)) row.emplace_back(first_common_ + i, ramp.d_shared[static_cast<std::size_t>(i)]);
    }
    const Index first_own = own_ * static_cast<Index>(first);
    for (Index i = 0; i < 2; ++i) {
      row.emplace_back(first_own + i, ramp.d_first[static_cast<std::size_t>(i)]);
      row.emplace_back(first_own + own_ + i, ramp.d_second[static_cast<std::size_t>(i)]);
    }
    for (const auto& [i, left] : row) {
      for (const auto& [j, right] : row) add(i, j, left * right);
    }
  }

  /// S' H^-1 S; not a number where H is singular.
  [[nodiscard]] MatrixXd inverse_through(const Selection& selection) const {
    const Index size = first_common_ + common_;
    Eigen::SparseMatrix<double> hessian(size, size);
    hessian.setFromTriplets(entries_.begin(), entries_.end());
    MatrixXd columns = MatrixXd::Zero(size, kQuantities);
    for (Index row = 0; row < first_common_; row += own_) columns.middleRows(row, own_) = selection.own;
    columns.bottomRows(common_) = selection.common;
    for (const Index i : held_) columns.row(first_common_ + i).setZero();
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(hessian);
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    if (factor.info() != Eigen::Success) return MatrixXd::Constant(kQuantities, kQuantities, kNone);
    return columns.transpose() * factor.solve(columns);
  }

 private:
  void add(Index row, Index column, double value) { entries_.emplace_back(row, column, value); }
  [[nodiscard]] bool is_held(Index i) const { return std::find(held_.begin(), held_.end(), i) != held_.end(); }

  const BlockFit& fit_;
  Index own_, common_, first_common_;
  std::vector<Index> held_;
  std::vector<Eigen::Triplet<double>> entries_;
};

}  // namespace

MatrixXd white_covariance(const BlockFit& fit, const std::vector<Normal>& normals, const Held& held, bool continuous) {
  SparseNormal sum(fit, held);
  for (std::size_t cycle = 0; cycle < normals.size(); ++cycle) {
    sum.add_cycle(cycle, normals[cycle]);
    if (continuous && cycle + 1 < normals.size() && fit.data(cycle).continuous_with_next) sum.add_ramp(cycle);
  }
  return sum.inverse_through(select(fit));
}

MatrixXd jackknife_covariance(const BlockFit& fit, const std::vector<Normal>& normals, const Held& held) {
  const Index common = common_size(fit);
  const std::size_t cycles = normals.size();
  const std::vector<Index> held_common = held_rows(held);
  std::vector<MatrixXd> reduced(cycles);
  std::vector<VectorXd> score(cycles);
  std::vector<MatrixXd> response(cycles);  // d own / d common
  MatrixXd total = MatrixXd::Zero(common, common);
  for (std::size_t i = 0; i < cycles; ++i) {
    const Normal& n = normals[i];
    response[i] = -n.own.ldlt().solve(n.cross.transpose());
    reduced[i] = n.common + n.cross * response[i];
    score[i] = n.score + response[i].transpose() * n.own_score;
    total += reduced[i];
  }
  MatrixXd replicates(static_cast<Index>(cycles), static_cast<Index>(kQuantities));
  double sum_onset = 0.0;
  double sum_level = 0.0;
  MatrixXd sum_response = MatrixXd::Zero(own_size(fit), common);
  for (std::size_t i = 0; i < cycles; ++i) {
    sum_onset += fit.parameters.cycles[i][1];
    sum_level += fit.parameters.cycles[i][2];
    sum_response += response[i];
  }
  const double others = static_cast<double>(cycles) - 1.0;
  const Selection selection = select(fit);
  for (std::size_t i = 0; i < cycles; ++i) {
    MatrixXd remaining = total - reduced[i];
    VectorXd gradient = score[i];
    hold_rows(remaining, held_common);
    for (const Index row : held_common) gradient(row) = 0.0;
    const VectorXd step = remaining.ldlt().solve(gradient);  // dropping r_i'r_i changes the gradient by -score_i
    const MatrixXd mean_response = (sum_response - response[i]) / others;
    VectorXd quantities = selection.common.transpose() * step;
    quantities(kOnsetForce) = (sum_onset - fit.parameters.cycles[i][1]) / others + mean_response.row(1).dot(step);
    if (fit.level().per_cycle) {
      quantities(kLevel) = (sum_level - fit.parameters.cycles[i][2]) / others + mean_response.row(2).dot(step);
    }
    replicates.row(static_cast<Index>(i)) = quantities.transpose();
  }
  const MatrixXd centred = replicates.rowwise() - replicates.colwise().mean();
  return others / static_cast<double>(cycles) * centred.transpose() * centred;
}

}  // namespace slipfit::fit
