#include "fit/inference/normals.hpp"

#include <utility>

#include "fit/cycle/side_by_side.hpp"

namespace slipfit::fit {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

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
                                                parameters.globals, parameters.level.front());
  std::vector<Index> of_row = columns.of_steady(problem.recordings.front().model(0).globals());
  const Index globals = static_cast<Index>(of_row.size()) - 1;
  Linearised lines{VectorXd::Constant(1, steady.value), MatrixXd(1, globals + 1), MatrixXd(1, 0)};
  for (Index i = 0; i < globals; ++i) lines.common(0, i) = steady.by_global[static_cast<std::size_t>(i)];
  lines.common(0, globals) = steady.by_level;
  return normal_of(std::move(lines), std::move(of_row));
}

}  // namespace

std::vector<Normal> normals_of(const Problem& problem) {
  const CommonColumns columns(problem);
  std::vector<Normal> normals;
  for (std::size_t r = 0; r < problem.recordings.size(); ++r) {
    const BlockFit& recording = problem.recordings[r];
    const std::size_t first = normals.size();
    normals.resize(first + recording.size());
    for_cycles(recording.size(), recording.residuals(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end; ++c) normals[first + c] = normal_of(linearise(recording, c), columns.of(r));
    });
  }
  for (std::size_t i = 0; problem.sweep.sharing.level && i < problem.sweep.steady.size(); ++i) {
    normals.push_back(normal_of(problem.sweep.steady[i], problem, columns));
  }
  return normals;
}

std::vector<Normal> normals_without(const Problem& all, std::size_t recording, const std::vector<Normal>& normals,
                                    const Problem& others) {
  const CommonColumns columns(others);
  std::vector<Normal> kept;
  auto next = normals.begin();
  for (std::size_t r = 0; r < all.recordings.size(); ++r) {
    for (std::size_t cycle = 0; cycle < all.recordings[r].size(); ++cycle, ++next) {
      if (r == recording) continue;
      kept.push_back(*next);
      kept.back().columns = columns.of(r < recording ? r : r - 1);
    }
  }
  kept.insert(kept.end(), next, normals.end());  // steady ones have the first columns alone, which stay
  return kept;
}

}  // namespace slipfit::fit
