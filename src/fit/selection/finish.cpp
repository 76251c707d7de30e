#include "fit/selection/finish.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "core/statistics.hpp"
#include "core/thresholds.hpp"
#include "fit/inference/smoothing.hpp"
#include "fit/inference/uncertainty.hpp"
#include "fit/problem/solve.hpp"
#include "fit/selection/outliers.hpp"

namespace slipfit::fit {
namespace {

constexpr int kMostIterations = 60;
constexpr double kFinishTolerance = 1e-3;  // SolveOptions::tolerance

bool is_regular(const Uncertainty& uncertainty, const Held& held) {
  const CoordinateMatrix& c = uncertainty.covariance;
  const auto is_known = [&](Coordinate i) { return held[static_cast<std::size_t>(i)] || c(i, i) > 0.0; };
  return c.allFinite() && is_known(kLogStiffness) && is_known(kLogFrequency) && is_known(kDamping);
}

double joined_ramps(const BlockFit& fit) {
  double ramps = 0.0;
  for (std::size_t i = 0; i + 1 < fit.size(); ++i) ramps += fit.data(i).continuous_with_next ? 1.0 : 0.0;
  return ramps;
}

/// Joined ramps halve the error of k where the data agree: F test, one degree of freedom a ramp.
DampedFit with_joined_ramps(DampedFit loose) {
  const double ramps = joined_ramps(loose.blocks);
  if (ramps < 1.0) return loose;
  DampedFit joined = loose;
  if (!std::isfinite(solve(joined.blocks, {joined.held, true, kMostIterations, kFinishTolerance}))) return loose;
  joined.continuous = true;
  joined.uncertainty = estimate_uncertainty(joined.blocks, {joined.held, true});
  if (!is_regular(joined.uncertainty, joined.held)) return loose;
  const double freedom = std::max(1.0, loose.uncertainty.degrees_of_freedom);
  const double ratio = (joined.uncertainty.chi2 - loose.uncertainty.chi2) / ramps / (loose.uncertainty.chi2 / freedom);
  const bool agrees = ratio <= 0.0 || fisher_above(ratio, ramps, freedom) > thresholds::kProven;
  return agrees ? joined : loose;
}

/// The residuals of a cycle cut from what its samples differ from the model by, as CycleModel::evaluate orders them.
Eigen::VectorXd residuals_of(const CycleData& cycle, double noise) {
  const CycleRows rows = rows_of(cycle);
  return rows.weight * rows.force / noise;
}

/// Computes the moves of the coordinates by rounded copies of the model.
class RoundingMoves {
 public:
  RoundingMoves(const FitInput& input, const DampedFit& result)
      : input_(input),
        result_(result),
        influences_(influences_of(result.blocks, select(result.blocks), {result.held, result.continuous})) {}

  [[nodiscard]] Moves moves(double step) const {
    const Residuals residuals = residuals_of(input_.recording, result_.blocks);
    const std::span<const double> force = input_.recording.force();
    std::vector<double> model(force.begin(), force.end());
    for (std::size_t i = 0; i < model.size(); ++i) model[i] -= residuals.value[i];
    const RoundedCopies copies(model, step, result_.uncertainty.noise);
    Moves moves(kRoundedCopies, kCoordinates);
    for (unsigned copy = 0; copy < kRoundedCopies; ++copy) {
      std::vector<double> errors = copies.draw(copy);
      for (std::size_t i = 0; i < model.size(); ++i) errors[i] -= model[i];
      moves.row(copy) = move_by(errors);
    }
    return moves;
  }

 private:
  /// `errors`: of every sample.
  [[nodiscard]] Eigen::RowVectorXd move_by(const std::vector<double>& errors) const {
    const BlockFit& fit = result_.blocks;
    Eigen::RowVectorXd move = Eigen::RowVectorXd::Zero(kCoordinates);
    std::size_t next = 0;
    for (CycleData& cycle :
         cut_cycles_of(errors, input_.recording, input_.segmentation, result_.half_width_s, result_.excluded)) {
      if (next == fit.size() || cycle.slip != fit.data(next).slip) continue;
      cycle.weight = fit.data(next).weight;
      move += residuals_of(cycle, fit.scales().noise).transpose() * influences_[next];
      ++next;
    }
    return move;
  }

  const FitInput& input_;
  const DampedFit& result_;
  std::vector<Eigen::MatrixXd> influences_;
};

}  // namespace

double tolerated_misfit(const Quality& quality) {
  return 0.5 * quality.quantisation_step.value_or(0.0);
}

std::optional<DampedFit> with_uncertainty(DampedFit draft, const Quality& quality) {
  draft.uncertainty = estimate_uncertainty(draft.blocks, {draft.held, false});
  if (!is_regular(draft.uncertainty, draft.held)) return std::nullopt;
  const bool is_coulomb = draft.blocks.scales().law == FrictionLaw::Coulomb;  // RampResidual
  const LevelModel& level = draft.blocks.level();
  if (is_coulomb && !draft.blocks.scales().stiffness_drifts && !level.per_cycle && !level.reloading &&
      !draft.uncertainty.from_cycles) {
    draft = with_joined_ramps(std::move(draft));
  }
  draft.misfit = find_misfit(draft.blocks, tolerated_misfit(quality));
  return draft;
}

std::optional<DampedFit> finish_fit(const FitInput& input, DampedFit fit) {
  const Quality& quality = input.quality;
  // Noise of a step and more spreads the rounding evenly: it is white then.
  if (quality.quantisation_step && fit.uncertainty.noise < *quality.quantisation_step) {
    const Moves moves = RoundingMoves(input, fit).moves(*quality.quantisation_step);
    if (!moves.allFinite()) return std::nullopt;
    fit.uncertainty = with_rounding(fit.uncertainty, moves);
  }
  if (fit.misfit) fit.uncertainty = with_misfit(fit.uncertainty, influence_of_segments(fit.blocks, fit.held));
  return fit;
}

}  // namespace slipfit::fit
