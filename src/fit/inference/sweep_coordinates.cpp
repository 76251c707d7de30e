#include "fit/inference/sweep_coordinates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "fit/inference/covariance.hpp"
#include "fit/inference/uncertainty.hpp"

namespace slipfit::fit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// One value a recording, or one that they share.
VectorXd shared_or_own(const VectorXd& of_recordings, bool shared) {
  return shared ? VectorXd(of_recordings.head(1)) : of_recordings;
}

VectorXd levels_of(const SweepSolution& solution) {
  VectorXd levels(static_cast<Index>(solution.recordings.size()));
  for (Index r = 0; r < levels.size(); ++r) {
    levels(r) = solution.recordings[static_cast<std::size_t>(r)].parameters.level[0];
  }
  return shared_or_own(levels, solution.sweep.sharing.level);
}

/// Squared standard error of the mean of what the recordings have each for themselves.
double variance_of_mean(const VectorXd& values) {
  const auto count = static_cast<double>(values.size());
  if (values.size() < 2) return 0.0;
  return (values.array() - values.mean()).square().sum() / (count * (count - 1.0));
}

/// Returns the line of static friction: without ageing it is level, at the mean.
AgeingLine static_friction_line(const SweepSolution& solution, const StaticFriction& kind) {
  if (kind) return ageing_line(solution, *kind);
  const VectorXd differences = shared_or_own(differences_of(solution), solution.sweep.sharing.difference);
  const Index count = differences.size();
  return {VectorXd::Constant(count, 1.0 / static_cast<double>(count)), VectorXd::Zero(count),
          static_cast<double>(count) * variance_of_mean(differences), false};
}

Selection selection_of(const SweepSolution& solution, const AgeingLine& line) {
  const CommonColumns columns(solution.problem());
  Selection selection{MatrixXd::Zero(columns.size(), kCoordinates), {}};
  for (std::size_t r = 0; r < solution.recordings.size(); ++r) {
    for (const Coordinate coordinate : solution.recordings[r].columns().coordinates()) {
      if (!is_of_recording(coordinate)) selection.common(*columns.find(r, coordinate), coordinate) = 1.0;
    }
  }
  const Index levels = levels_of(solution).size();
  for (Index r = 0; r < levels; ++r) {
    selection.common(columns.level(static_cast<std::size_t>(r)), kLevel) = 1.0 / static_cast<double>(levels);
  }
  for (Index r = 0; r < line.rate_weights.size(); ++r) {
    const Index column = *columns.find(static_cast<std::size_t>(r), kDifference);
    selection.common(column, kDifference) = line.difference_weights(r);
    selection.common(column, kAgeing) = line.rate_weights(r);
  }
  const auto rises = static_cast<double>(rises_of(solution).size());
  for (std::size_t r = 0; r < solution.recordings.size(); ++r) {
    const std::optional<Index> rise = columns.find(r, kReloadForce);
    const double unit = solution.recordings[r].scales().force / solution.population(r).force;
    if (rise) selection.common(*rise, kReloadForce) = unit / rises;
  }
  return selection;
}

/// Adds the scatter of the recordings around their line. The recordings count then, and not their cycles.
void add_scatter(Spread& spread, const SweepSolution& solution, const AgeingLine& line, const StaticFriction& kind) {
  MatrixXd scatter(line.rate_weights.size(), 2);
  scatter << line.difference_weights, line.rate_weights;
  spread.covariance.block<2, 2>(kDifference, kDifference) += line.residual_variance * scatter.transpose() * scatter;
  if (!kind) return;
  const double recordings = std::max(1.0, static_cast<double>(solution.recordings.size()) - 2.0);
  spread.degrees_of_freedom = std::min(spread.degrees_of_freedom, recordings);
}

}  // namespace

Coordinates coordinates_of(const SweepSolution& solution, const StaticFriction& kind) {
  const AgeingLine line = static_friction_line(solution, kind);
  const VectorXd differences = shared_or_own(differences_of(solution), solution.sweep.sharing.difference);
  Coordinates values = solution.shared();
  values(kLevel) = levels_of(solution).mean();
  values(kDifference) = line.difference_weights.dot(differences);
  values(kAgeing) = line.rate_weights.dot(differences);
  values(kAgeingTime) = kind ? kind->value : 0.0;
  if (const VectorXd rises = rises_of(solution); rises.size() > 0) values(kReloadForce) = rises.mean();
  return values;
}

Spread spread_of(const SweepData& data, const SweepSolution& solution, const std::vector<Normal>& normals,
                 const StaticFriction& kind) {
  const Problem problem = solution.problem();
  const AgeingLine line = static_friction_line(solution, kind);
  const Selection selection = selection_of(solution, line);
  const bool correlated = std::any_of(data.fitted.begin(), data.fitted.end(),
                                      [&](std::size_t i) { return data.single[i]->uncertainty.from_cycles; });
  Spread spread;
  if (correlated) {
    spread.covariance = jackknife_covariance(problem, normals, selection, solution.held);
    spread.degrees_of_freedom = std::max(1.0, static_cast<double>(normals.size()) - 1.0);
  } else {
    const double variance = std::max(1.0, solution.chi2 / solution.degrees_of_freedom);
    spread.covariance = variance * white_covariance(problem, normals, selection, {solution.held});
    spread.degrees_of_freedom = static_cast<double>(solution.cycles());
  }
  spread.covariance(kLevel, kLevel) += variance_of_mean(levels_of(solution));
  spread.covariance(kReloadForce, kReloadForce) += variance_of_mean(rises_of(solution));
  // Recordings whose cycles are those of the model, and that lie on the line within their own errors, count as the
  // cycles do; otherwise they scatter, and they count.
  if (!(kind && line.explains && !correlated)) add_scatter(spread, solution, line, kind);
  return spread;
}

void add_cutoff(const SweepSolution& solution, const StaticFriction& kind, Spread& spread) {
  if (!kind) return;
  const double quantile = t_quantile(spread.degrees_of_freedom) / t_quantile(std::numeric_limits<double>::infinity());
  spread.scatter.block<3, 3>(kDifference, kDifference) +=
      ageing_line(solution, *kind).by_cutoff / (quantile * quantile);
  spread.scatter_degrees_of_freedom = spread.degrees_of_freedom;
}

Coordinates with_damping_cut(const Coordinates& values, const CoordinateMatrix& covariance) {
  const double variance = covariance(kDamping, kDamping);
  if (!(values(kDamping) < 0.0) || !(variance > 0.0)) return values;
  Coordinates cut = values - covariance.col(kDamping) * (values(kDamping) / variance);
  cut(kDamping) = 0.0;
  return cut;
}

}  // namespace slipfit::fit
