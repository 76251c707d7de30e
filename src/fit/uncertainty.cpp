#include "fit/uncertainty.hpp"

#include <Eigen/Sparse>
#include <algorithm>
#include <cmath>

namespace slipfit::fit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// One cycle's part of the normal equations; `common` are the shared parameters and the level's columns.
struct Normal {
  MatrixXd common;  // common x common
  MatrixXd cross;   // common x own
  MatrixXd own;     // own x own
  VectorXd score;   // J' r for common
  VectorXd own_score;
  VectorXd residuals;
};

Index common_size(const BlockFit& fit) {
  return static_cast<Index>(kShared + fit.level().columns());
}
Index own_size(const BlockFit& fit) {
  return fit.level().per_cycle ? 3 : 2;
}

Normal normal_of(const BlockFit& fit, std::size_t cycle) {
  const CycleModel& model = fit.model(cycle);
  const auto rows = static_cast<Index>(model.residuals());
  const auto terms = static_cast<Index>(fit.level().columns());
  Normal normal;
  normal.residuals.resize(rows);
  RowMajor shared(rows, static_cast<Index>(kShared));
  RowMajor level(rows, terms);
  RowMajor own(rows, own_size(fit));
  model.evaluate(fit.parameters.shared.data(), fit.level_data(), fit.parameters.cycles[cycle].data(),
                 normal.residuals.data(), {shared.data(), terms > 0 ? level.data() : nullptr, own.data()});
  MatrixXd common(rows, common_size(fit));
  common << shared, level;
  normal.common = common.transpose() * common;
  normal.cross = common.transpose() * own;
  normal.own = own.transpose() * own;
  normal.score = common.transpose() * normal.residuals;
  normal.own_score = own.transpose() * normal.residuals;
  return normal;
}

/// How the quantities hang on the common parameters and on each cycle's own ones.
struct Selection {
  MatrixXd common;  // common x quantities
  MatrixXd own;     // own x quantities, the same for every cycle: weight of one cycle in the mean
};

Selection select(const BlockFit& fit, const std::vector<std::size_t>& cycles) {
  Selection selection{MatrixXd::Zero(common_size(fit), kQuantities), MatrixXd::Zero(own_size(fit), kQuantities)};
  for (Index i = 0; i < static_cast<Index>(kShared); ++i) selection.common(i, i) = 1.0;
  const double share = 1.0 / static_cast<double>(cycles.size());
  selection.own(1, kOnsetForce) = share;
  if (fit.level().per_cycle) {
    selection.own(2, kLevel) = share;
    return selection;
  }
  std::vector<double> values(fit.level().terms);
  std::vector<double> slopes(fit.level().terms);
  for (const std::size_t cycle : cycles) {
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

/// A held parameter: its row and column of the normal matrix become those of an exactly known one.
void hold_rows(MatrixXd& matrix, const std::vector<Index>& rows) {
  for (const Index row : rows) {
    matrix.row(row).setZero();
    matrix.col(row).setZero();
    matrix(row, row) = 1.0;
  }
}

/// Inverse normal matrix seen through the quantities: S' H^-1 S, with the ramps' coupling of neighbours where
/// continuous.
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
  std::vector<std::size_t> all(normals.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  const Selection selection = select(fit, all);
  MatrixXd columns = MatrixXd::Zero(size, kQuantities);
  for (Index c = 0; c < cycles; ++c) columns.middleRows(c * own, own) = selection.own;
  columns.bottomRows(common) = selection.common;
  for (const Index i : held_common) columns.row(first_common + i).setZero();
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(hessian);
  if (factor.info() != Eigen::Success) return MatrixXd::Constant(kQuantities, kQuantities, NAN);
  return columns.transpose() * factor.solve(columns);
}

/// Delete-one-cycle jackknife of the quantities, one Newton step each: CR3.
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
  const Selection selection = select(fit, all);
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

/// Correlation of neighbouring residuals inside the slips, where samples are fitted one by one.
void measure_lag1(const BlockFit& fit, const std::vector<Normal>& normals, Uncertainty& result) {
  double product = 0.0;
  double square = 0.0;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const auto samples = static_cast<Index>(fit.data(i).time_s.size());
    for (Index j = 0; j < samples; ++j) {
      const double r = normals[i].residuals(j);
      square += r * r;
      if (j > 0) {
        product += r * normals[i].residuals(j - 1);
        result.lag1_pairs += 1.0;
      }
    }
  }
  if (square > 0.0) result.lag1_correlation = product / square;
}

void count_residuals(const BlockFit& fit, const std::vector<Normal>& normals, Uncertainty& result) {
  const double noise2 = fit.scales().noise * fit.scales().noise;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    result.chi2 += normals[i].residuals.squaredNorm();
    result.samples += static_cast<double>(fit.data(i).time_s.size());
    for (const auto* bins : {&fit.data(i).bins_before, &fit.data(i).bins_after}) {
      for (const StickBin& bin : *bins) {
        result.chi2 += bin.scatter / noise2;
        result.samples += bin.count;
      }
    }
  }
}

/// Root mean square over the cycles of the error that noise of variance 1 gives to an onset force.
double error_of_onset_force(const std::vector<Normal>& normals) {
  double square = 0.0;
  for (const Normal& n : normals) square += n.own.inverse()(1, 1) / static_cast<double>(normals.size());
  return std::sqrt(std::max(0.0, square));
}

double spread_of_onset_force(const BlockFit& fit) {
  double sum = 0.0;
  double square = 0.0;
  for (const Own& own : fit.parameters.cycles) sum += own[1];
  const double mean = sum / static_cast<double>(fit.size());
  for (const Own& own : fit.parameters.cycles) square += (own[1] - mean) * (own[1] - mean);
  return std::sqrt(square / std::max(1.0, static_cast<double>(fit.size()) - 1.0));
}

}  // namespace

double reduced_chi2(const BlockFit& fit) {
  double chi2 = 0.0;
  double samples = 0.0;
  const double noise2 = fit.scales().noise * fit.scales().noise;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    chi2 += fit.cycle_sum_of_squares(i);
    samples += static_cast<double>(fit.data(i).time_s.size());
    for (const auto* bins : {&fit.data(i).bins_before, &fit.data(i).bins_after}) {
      for (const StickBin& bin : *bins) {
        chi2 += bin.scatter / noise2;
        samples += bin.count;
      }
    }
  }
  const double parameters = static_cast<double>(common_size(fit) + own_size(fit) * static_cast<Index>(fit.size()));
  return chi2 / std::max(1.0, samples - parameters);
}

Uncertainty estimate_uncertainty(const BlockFit& fit, const Held& held, bool continuous) {
  std::vector<Normal> normals;
  normals.reserve(fit.size());
  for (std::size_t i = 0; i < fit.size(); ++i) normals.push_back(normal_of(fit, i));
  Uncertainty result;
  count_residuals(fit, normals, result);
  measure_lag1(fit, normals, result);
  result.onset_force_sd = spread_of_onset_force(fit);
  const auto cycles = static_cast<double>(fit.size());
  double ramps = 0.0;
  for (std::size_t i = 0; continuous && i + 1 < fit.size(); ++i) ramps += fit.data(i).continuous_with_next ? 1.0 : 0.0;
  const double white_freedom =
      result.samples - static_cast<double>(common_size(fit)) - cycles * static_cast<double>(own_size(fit)) + ramps;
  const double variance = result.chi2 / std::max(1.0, white_freedom);
  result.noise = fit.scales().noise * std::sqrt(variance);
  result.onset_force_error = error_of_onset_force(normals) * std::sqrt(variance);

  // White intervals hold where neighbouring residuals are uncorrelated; the bound is four times the error of a
  // correlation, and 0.08 where that is smaller (below it the intervals are short by less than 8 %).
  const double white_bound = std::max(0.08, 4.0 / std::sqrt(std::max(1.0, result.lag1_pairs)));
  result.from_cycles = std::abs(result.lag1_correlation) > white_bound && !continuous;
  Held held_damping = held;
  held_damping.damping = true;
  if (result.from_cycles) {
    result.covariance = jackknife_covariance(fit, normals, held);
    result.covariance_given_damping = jackknife_covariance(fit, normals, held_damping);
    result.degrees_of_freedom = std::max(1.0, cycles - 1.0);
  } else {
    result.covariance = variance * white_covariance(fit, normals, held, continuous);
    result.covariance_given_damping = variance * white_covariance(fit, normals, held_damping, continuous);
    result.degrees_of_freedom = std::max(1.0, white_freedom);
  }
  return result;
}

}  // namespace slipfit::fit
