#include "fit/inference/sweep_outcome.hpp"

#include <algorithm>
#include <cmath>

#include "fit/inference/ageing_line.hpp"
#include "fit/inference/rate_profile.hpp"
#include "fit/inference/sliding_model.hpp"

namespace slipfit::fit {
namespace {

/// A recording left out moves a parameter by chance by this many standard errors of the shift in fewer than one sweep
/// of 300 (5 recordings, 7 parameters).
constexpr double kShiftSigmas = 4.5;

std::vector<std::optional<LeftOut>> leave_out_each(const SweepData& data, const SweepSolution& solution,
                                                   StaticFriction kind) {
  std::vector<std::optional<LeftOut>> each;
  for (std::size_t recording = 0; recording < solution.recordings.size(); ++recording) {
    each.emplace_back();
    const std::optional<SweepSolution> others = leave_out(solution, recording);
    if (others) each.back() = LeftOut{coordinates_of(*others, kind), spread_of(data, *others, kind)};
  }
  return each;
}

double count_of(const std::vector<std::optional<LeftOut>>& each) {
  return static_cast<double>(std::count_if(each.begin(), each.end(), [](const auto& one) { return one.has_value(); }));
}

/// Delete-one-recording jackknife.
CoordinateMatrix jackknife_over(const std::vector<std::optional<LeftOut>>& each) {
  const double count = count_of(each);
  Coordinates mean = Coordinates::Zero();
  for (const auto& one : each) {
    if (one) mean += one->values / count;
  }
  CoordinateMatrix sum = CoordinateMatrix::Zero();
  for (const auto& one : each) {
    if (one) sum += (count - 1.0) / count * (one->values - mean) * (one->values - mean).transpose();
  }
  return sum;
}

/// The recordings disagree by more than noise and the scatter of the cycles explain: the variance of the shift between
/// an efficient estimate and one from fewer data is the difference of their variances (Hausman).
bool recordings_disagree(const SweepOutcome& outcome) {
  if (count_of(outcome.left_out) < 3.0) return false;
  const CoordinateMatrix& covariance = outcome.spread.covariance;
  for (const auto& one : outcome.left_out) {
    for (Eigen::Index i = 0; one && i < kCoordinates; ++i) {
      const double least = 0.05 * covariance(i, i);  // rounding and iteration: the difference may come out as nothing
      const double variance = std::max(one->spread.covariance(i, i) - covariance(i, i), least);
      const double shift = one->values(i) - outcome.values(i);
      if (variance > 0.0 && shift * shift > kShiftSigmas * kShiftSigmas * variance) return true;
    }
  }
  return false;
}

}  // namespace

SweepOutcome outcome_of(const SweepData& data, const SweepSolution& solution) {
  const StaticFriction kind = static_friction_of(solution);
  SweepOutcome outcome{solution, kind, coordinates_of(solution, kind), spread_of(data, solution, kind),
                       leave_out_each(data, solution, kind)};
  outcome.disagree = recordings_disagree(outcome);
  if (outcome.disagree) {
    Spread& spread = outcome.spread;
    spread.covariance += jackknife_over(outcome.left_out);
    spread.degrees_of_freedom = std::max(1.0, std::min(spread.degrees_of_freedom, count_of(outcome.left_out) - 1.0));
  }
  AlongRate along = profile_rate(solution, kind, outcome.values, outcome.spread);
  outcome.values = along.best;
  outcome.spread = std::move(along.spread);
  return outcome;
}

double left_out_error(const SweepOutcome& outcome) {
  const SweepSolution& solution = outcome.solution;
  double square = 0.0;
  for (std::size_t recording = 0; recording < solution.recordings.size(); ++recording) {
    const BlockFit& blocks = solution.recordings[recording];
    const double speed = blocks.scales().speed_m_per_s;
    double error = std::log(kWidestFactor);
    if (const auto& one = outcome.left_out[recording]) {
      const SlidingModel model(with_damping_cut(one->values, one->spread.covariance), solution.sweep.units);
      const auto spacing = model.spacing(speed, solution.population(recording).load);
      if (spacing) error = std::min(error, std::abs(std::log(spacing->a / (speed * median_period_s(blocks)))));
    }
    square += error * error;
  }
  return std::sqrt(square / static_cast<double>(solution.recordings.size()));
}

}  // namespace slipfit::fit
