#include "fit/covariance.hpp"

#include <Eigen/Sparse>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fit/uncertainty.hpp"

namespace slipfit::fit {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Index common_size(const BlockFit& fit) {
  return static_cast<Index>(kShared + fit.level().columns());
}
Index own_size(const BlockFit& fit) {
  return fit.level().per_cycle ? 3 : 2;
}

Linearised linearise(const BlockFit& fit, std::size_t cycle) {
  const CycleModel& model = fit.model(cycle);
  const auto rows = static_cast<Index>(model.residuals());
  const auto terms = static_cast<Index>(fit.level().columns());
  Linearised result;
  result.residuals.resize(rows);
  RowMajor shared(rows, static_cast<Index>(kShared));
  RowMajor level(rows, terms);
  RowMajor own(rows, own_size(fit));
  model.evaluate(fit.parameters.shared.data(), fit.level_data(), fit.parameters.cycles[cycle].data(),
                 result.residuals.data(), {shared.data(), terms > 0 ? level.data() : nullptr, own.data()});
  result.common.resize(rows, common_size(fit));
  result.common << shared, level;
  result.own = own;
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

MatrixXd white_covariance(const BlockFit& fit, const std::vector<Normal>& normals, const Held& held, bool continuous) {
  const Index own = own_size(fit);
  const Index common = common_size(fit);
  const auto cycles = static_cast<Index>(normals.size());
  const Index first_common = own * cycles;
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](Index row, Index col, double value) { entries.emplace_back(row, col, value); };
  const std::vector<Index> held_common = held_rows(held);
  const auto is_held = [&](Index i) {
    return std::find(held_common.begin(), held_common.end(), i) != held_common.end();
  };
  for (Index c = 0; c < cycles; ++c) {
    const Normal& n = normals[static_cast<std::size_t>(c)];
    for (Index i = 0; i < own; ++i) {
      for (Index j = 0; j < own; ++j) add(c * own + i, c * own + j, n.own(i, j));
      for (Index j = 0; j < common; ++j) {
        if (is_held(j)) continue;
        add(c * own + i, first_common + j, n.cross(j, i));
        add(first_common + j, c * own + i, n.cross(j, i));
      }
    }
    for (Index i = 0; i < common; ++i) {
      for (Index j = 0; j < common; ++j) {
        if (!is_held(i) && !is_held(j)) add(first_common + i, first_common + j, n.common(i, j));
      }
    }
    if (!continuous || c + 1 >= cycles || !fit.data(static_cast<std::size_t>(c)).continuous_with_next) continue;
    const auto first = static_cast<std::size_t>(c);
    const RampResidual ramp =
        ramp_residual(fit, first, fit.parameters.shared.data(), fit.parameters.cycles[first].data(),
                      fit.parameters.cycles[first + 1].data());
    std::vector<std::pair<Index, double>> row;
    for (Index i = 0; i < 3; ++i) {
      if (!is_held(i)) row.emplace_back(first_common + i, ramp.d_shared[static_cast<std::size_t>(i)]);
    }
    for (Index i = 0; i < 2; ++i) {
      row.emplace_back(c * own + i, ramp.d_first[static_cast<std::size_t>(i)]);
      row.emplace_back((c + 1) * own + i, ramp.d_second[static_cast<std::size_t>(i)]);
    }
    for (const auto& [i, left] : row) {
      for (const auto& [j, right] : row) add(i, j, left * right);
    }
  }
  for (const Index i : held_common) add(first_common + i, first_common + i, 1.0);

  const Index size = first_common + common;
  Eigen::SparseMatrix<double> hessian(size, size);
  hessian.setFromTriplets(entries.begin(), entries.end());
  const Selection selection = select(fit);
  MatrixXd columns = MatrixXd::Zero(size, kQuantities);
  for (Index c = 0; c < cycles; ++c) columns.middleRows(c * own, own) = selection.own;
  columns.bottomRows(common) = selection.common;
  for (const Index i : held_common) columns.row(first_common + i).setZero();
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(hessian);
  if (factor.info() != Eigen::Success)
    return MatrixXd::Constant(kQuantities, kQuantities, std::numeric_limits<double>::quiet_NaN());
  return columns.transpose() * factor.solve(columns);
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
  std::vector<std::size_t> all(cycles);
  for (std::size_t i = 0; i < cycles; ++i) all[i] = i;
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
