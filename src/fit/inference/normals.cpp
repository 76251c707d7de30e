#include "fit/inference/normals.hpp"

#include "fit/cycle/side_by_side.hpp"
#include "fit/problem/lines.hpp"

namespace slipfit::fit {

using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<Normal> normals_of(const Problem& problem) {
  const CommonColumns columns(problem);
  std::vector<Normal> normals;
  for (std::size_t r = 0; r < problem.recordings.size(); ++r) {
    const BlockFit& recording = problem.recordings[r];
    const std::size_t first = normals.size();
    normals.resize(first + recording.size());
    for_cycles(recording.size(), recording.residuals(), [&](std::size_t begin, std::size_t end) {
      MatrixXd lines;
      for (std::size_t c = begin; c < end; ++c) {
        evaluate_lines(recording.model(c), recording.values(c), lines);
        normals[first + c] = {columns.of(r), products_of(lines), lines.rightCols<1>()};
      }
    });
  }
  if (!problem.sweep.sharing.level) return normals;
  const BlockFit& any = problem.recordings.front();
  for (const SteadyRun& run : problem.sweep.steady) {
    const SteadyResidual steady = steady_residual(run, problem.sweep.units, any.scales().law, any.parameters.values,
                                                  any.parameters.level.front());
    normals.push_back({columns.of_steady(), products_of(steady, any.columns()), VectorXd()});
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
  for (; next != normals.end(); ++next) {
    kept.push_back(*next);
    kept.back().columns = columns.of_steady();
  }
  return kept;
}

}  // namespace slipfit::fit
