#include "fit/inference/covariance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "fit/problem/normals.hpp"

namespace slipfit::fit {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd common_steps(const RowMajor& reduced, Index sides, const std::vector<Index>& held) {
  const Index common = reduced.cols() - sides;
  MatrixXd hessian = reduced.topLeftCorner(common, common).selfadjointView<Eigen::Upper>();
  MatrixXd pull = reduced.topRightCorner(common, sides);
  for (const Index i : held) {
    hessian.row(i).setZero();
    hessian.col(i).setZero();
    hessian(i, i) = 1.0;
    pull.row(i).setZero();
  }
  return -hessian.ldlt().solve(pull);
}

Coordinates move_of(const Selection& selection, const Elimination& elimination, const MatrixXd& steps) {
  const RowMajor own = elimination.own_steps(steps, 1.0);
  const Index local = selection.local.rows();
  VectorXd sum = VectorXd::Zero(local);
  for (Index row = 0; row < own.rows(); row += local) sum += own.col(0).segment(row, local);
  const double cycles = static_cast<double>(own.rows()) / static_cast<double>(local);
  return selection.common.transpose() * steps.col(0) + selection.local.transpose() * sum / cycles;
}

namespace {

/// - H^-1 S, where S are the derivatives of the coordinates with respect to all parameters.
struct Response {
  MatrixXd common;
  RowMajor own;  ///< one cycle after the other
};

/// The ramp from this cycle of the only recording to the next where they are joined; S has no rows for it.
std::optional<RampResidual> ramp_after(const BlockFit& fit, std::size_t cycle, bool continuous) {
  if (!continuous || cycle + 1 >= fit.size() || !fit.data(cycle).continuous_with_next) return std::nullopt;
  const Parameters& p = fit.parameters;
  RampResidual ramp = ramp_residual(fit, cycle, p.values, p.cycles[cycle].data(), p.cycles[cycle + 1].data());
  ramp.value = 0.0;
  return ramp;
}

/// `own`: S of the own parameters of each cycle.
Response response_of(const Problem& problem, const std::vector<Normal>& normals, const Selection& selection,
                     const MatrixXd& own, const Solved& solved) {
  const CommonColumns columns(problem);
  Elimination elimination(columns.size(), 0.0, kCoordinates);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Normal& normal = normals[i];
    const Index size = normal.common() + normal.own();
    RowMajor rows = RowMajor::Zero(size + kCoordinates, size + kCoordinates);
    rows.topLeftCorner(size, size) = normal.products.topLeftCorner(size, size);
    if (own.rows() > 0 && normal.own() == own.rows()) {
      rows.block(normal.common(), size, normal.own(), kCoordinates) = own;
    }
    const std::optional<RampResidual> ramp = ramp_after(problem.recordings.front(), i, solved.continuous);
    elimination.add_cycle(rows, normal.columns, ramp ? &*ramp : nullptr);
  }
  RowMajor reduced = elimination.common();
  if (elimination.is_singular()) reduced.setConstant(std::numeric_limits<double>::quiet_NaN());
  reduced.topRightCorner(selection.common.rows(), kCoordinates) += selection.common;
  const MatrixXd common = common_steps(reduced, kCoordinates, columns.held(solved.held));
  return {common, elimination.own_steps(common, 1.0)};
}

double cycles_of(const Problem& problem) {
  double cycles = 0.0;
  for (const BlockFit& recording : problem.recordings) cycles += static_cast<double>(recording.size());
  return cycles;
}

}  // namespace

CoordinateMatrix white_covariance(const Problem& problem, const std::vector<Normal>& normals,
                                  const Selection& selection, const Solved& solved) {
  const MatrixXd own = selection.local / cycles_of(problem);
  const Response response = response_of(problem, normals, selection, own, solved);
  CoordinateMatrix covariance = -selection.common.transpose() * response.common;
  for (Index row = 0; own.rows() > 0 && row < response.own.rows(); row += own.rows())
    covariance -= own.transpose() * response.own.middleRows(row, own.rows());
  return covariance;
}

std::vector<MatrixXd> influences_of(const BlockFit& fit, const Selection& selection, const Solved& solved) {
  const Problem problem{{&fit, 1}};
  const MatrixXd own = selection.local / cycles_of(problem);
  const Response response = response_of(problem, normals_of(problem), selection, own, solved);
  std::vector<MatrixXd> influences;
  MatrixXd lines;
  for (std::size_t cycle = 0; cycle < fit.size(); ++cycle) {
    evaluate_lines(fit.model(cycle), fit.values(cycle), lines);
    const Index common = response.common.rows();
    influences.emplace_back(lines.leftCols(common) * response.common +
                            lines.middleCols(common, own.rows()) *
                                response.own.middleRows(own.rows() * static_cast<Index>(cycle), own.rows()));
  }
  return influences;
}

NewtonStep newton_step(const Problem& problem, const std::vector<Normal>& normals, const Held& held) {
  const CommonColumns columns(problem);
  Elimination elimination(columns.size());
  NewtonStep result;
  for (const Normal& normal : normals) {
    const double square = normal.products(normal.products.rows() - 1, normal.products.cols() - 1);
    const bool is_cycle = normal.own() > 0;
    const HuberWeight weight = is_cycle
                                   ? huber_weight(std::sqrt(square), static_cast<std::size_t>(normal.residuals.size()))
                                   : HuberWeight{1.0, square};
    elimination.add_cycle(weight.factor * normal.products, normal.columns);
    result.sum_of_squares += weight.sum;
  }
  const RowMajor& reduced = elimination.common();
  result.step = common_steps(reduced, 1, columns.held(held));
  result.gain = -reduced.rightCols<1>().head(result.step.size()).dot(result.step);
  result.sum_of_squares -= result.gain;
  return result;
}

namespace {

/// d own / d common of a cycle, among all common parameters.
MatrixXd own_response(const Normal& normal, Index common) {
  const Index own = normal.own();
  const MatrixXd square =
      normal.products.block(normal.common(), normal.common(), own, own).selfadjointView<Eigen::Upper>();
  const MatrixXd follow =
      -square.ldlt().solve(normal.products.block(0, normal.common(), normal.common(), own).transpose());
  MatrixXd response = MatrixXd::Zero(own, common);
  for (Index i = 0; i < normal.common(); ++i) response.col(normal.columns[static_cast<std::size_t>(i)]) = follow.col(i);
  return response;
}

}  // namespace

CoordinateMatrix jackknife_covariance(const Problem& problem, const std::vector<Normal>& normals,
                                      const Selection& selection, const Held& held) {
  const CommonColumns columns(problem);
  const Index common = columns.size();
  const Index local = selection.local.rows();
  Elimination elimination(common);
  std::vector<RowMajor> parts;  // of the units: cycles and steady recordings
  std::vector<MatrixXd> responses;
  std::vector<VectorXd> locals;
  MatrixXd response = MatrixXd::Zero(local, common);
  VectorXd sum_of_locals = VectorXd::Zero(local);
  for (const Normal& normal : normals) {
    elimination.add_cycle(normal.products, normal.columns);
    parts.push_back(elimination.latest());
    if (local == 0) continue;
    responses.push_back(own_response(normal, common));
    response += responses.back();
    locals.emplace_back(
        Eigen::Map<const VectorXd>(problem.recordings.front().parameters.cycles[locals.size()].data(), local));
    sum_of_locals += locals.back();
  }
  RowMajor sum = elimination.common();
  sum.rightCols<1>().setZero();  // the gradient at the solution
  const std::vector<Index> held_columns = columns.held(held);
  const double others = static_cast<double>(parts.size()) - 1.0;
  MatrixXd replicates(static_cast<Index>(parts.size()), Index{kCoordinates});
  for (std::size_t i = 0; i < parts.size(); ++i) {
    RowMajor remaining = sum;
    add_scattered(-parts[i], normals[i].columns, remaining);
    const VectorXd step = common_steps(remaining, 1, held_columns);
    replicates.row(static_cast<Index>(i)) = selection.common.transpose() * step;
    if (local == 0) continue;
    const VectorXd mean_local = (sum_of_locals - locals[i] + (response - responses[i]) * step) / others;
    replicates.row(static_cast<Index>(i)) += selection.local.transpose() * mean_local;
  }
  const MatrixXd centred = replicates.rowwise() - replicates.colwise().mean();
  return others / static_cast<double>(parts.size()) * centred.transpose() * centred;
}

CoordinateMatrix given(const CoordinateMatrix& covariance, Coordinate held) {
  const double variance = covariance(held, held);
  if (!(variance > 0.0)) return covariance;
  return covariance - covariance.col(held) * covariance.row(held) / variance;
}

}  // namespace slipfit::fit
