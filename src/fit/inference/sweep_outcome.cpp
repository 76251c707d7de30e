#include "fit/inference/sweep_outcome.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "core/fit_thresholds.hpp"
#include "core/parallel.hpp"
#include "fit/inference/ageing_line.hpp"
#include "fit/inference/rate_profile.hpp"
#include "fit/inference/sensor_time.hpp"
#include "fit/inference/sliding_model.hpp"
#include "fit/inference/smoothing.hpp"
#include "fit/selection/sweep_solution.hpp"

namespace slipfit::fit {
namespace {

LeftOut fit_of(const SweepData& data, const NormalSolution& fit, const StaticFriction& kind) {
  return {coordinates_of(fit.solution, kind), spread_of(data, fit.solution, fit.normals, kind), reach_of(fit.solution)};
}

std::vector<std::optional<LeftOut>> leave_out_each(const SweepData& data, const NormalSolution& all,
                                                   const StaticFriction& kind) {
  const std::size_t count = all.solution.recordings.size();
  std::mutex notifying;
  return in_parallel(count, [&](std::size_t recording) -> std::optional<LeftOut> {
    if (data.notify_step) {
      const std::lock_guard lock(notifying);
      data.notify_step(fmt::format("fitting without recording {} of {}", recording + 1, count));
    }
    const std::optional<NormalSolution> others = leave_out(all, recording);
    if (!others) return std::nullopt;
    LeftOut one = fit_of(data, *others, kind);
    add_cutoff(others->solution, kind, one.spread);
    return one;
  });
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
      if (variance > 0.0 && shift * shift > thresholds::kOfManySigmas * thresholds::kOfManySigmas * variance)
        return true;
    }
  }
  return false;
}

/// ln of the spacing predicted without a recording over its own; empty where there is no prediction.
std::optional<double> left_out_difference(const SweepOutcome& outcome, std::size_t recording) {
  const std::optional<LeftOut>& one = outcome.left_out[recording];
  if (!one) return std::nullopt;
  const SweepSolution& solution = outcome.solution;
  const BlockFit& blocks = solution.recordings[recording];
  const double speed = blocks.scales().speed_m_per_s;
  const SlidingModel model(with_damping_cut(one->values, one->spread.covariance), solution.sweep.units);
  const auto spacing = model.spacing(speed, solution.population(recording).load);
  if (!spacing) return std::nullopt;
  return std::log(spacing->a / (speed * median_period_s(blocks)));
}

/// Returns the largest error of predictions of a recording at an end of the speeds by the others, per factor of e
/// outside their speeds: whatever the law lacks shows there first.
double error_beyond(const SweepOutcome& outcome) {
  double largest = 0.0;
  for (std::size_t recording = 0; recording < outcome.left_out.size(); ++recording) {
    const std::optional<double> difference = left_out_difference(outcome, recording);
    if (!difference) continue;
    const double speed = outcome.solution.recordings[recording].scales().speed_m_per_s;
    const double distance = outcome.left_out[recording]->reach.distance_to(speed);
    if (distance > thresholds::kBeyondDistance) largest = std::max(largest, std::abs(*difference) / distance);
  }
  return largest;
}

/// Returns the move of the coordinates of `outcome` per unit of one that is held.
std::optional<Coordinates> moves_by(Coordinate coordinate, const SweepSolution& solution, const SweepOutcome& outcome) {
  constexpr double kStep = 0.01;  // of ln w_n or zeta
  const std::optional<SweepSolution> other = with_held(solution, coordinate, kStep);
  if (!other) return std::nullopt;
  return (coordinates_of(*other, outcome.static_friction) - outcome.values) / kStep;
}

/// Returns the covariance with the errors of w_n and zeta, which `outcome` holds at the values by ring-downs or by a
/// stated mass alone.
CoordinateMatrix with_errors_of_held(const SweepData& data, const SweepSolution& solution,
                                     const SweepOutcome& outcome) {
  const CoordinateMatrix& held = outcome.spread.covariance;
  const std::optional<Coordinates> by_frequency = moves_by(kLogFrequency, solution, outcome);
  if (!by_frequency) return held;
  if (!data.motion) return with_mass(held, *by_frequency, data.mass->relative_error);
  const std::optional<Coordinates> by_damping = moves_by(kDamping, solution, outcome);
  if (!by_damping) return held;
  MotionMoves moves;
  moves << *by_frequency, *by_damping;
  return with_motion(held, moves, *data.motion);
}

bool depends_on_speed(const SweepSolution& solution) {
  return solution.recordings.front().scales().law != FrictionLaw::Coulomb;
}

}  // namespace

SweepOutcome outcome_of(const SweepData& data, const SweepSolution& solution) {
  const StaticFriction kind = static_friction_of(solution);
  const NormalSolution normal{solution, normals_of(solution.problem())};
  LeftOut all = fit_of(data, normal, kind);
  SweepOutcome outcome{
      solution, kind, all.values, std::move(all.spread), all.reach, leave_out_each(data, normal, kind)};
  if (const BlockFit* averaged = solution.with_sensor_time()) {
    outcome.spread.covariance = with_unknown_shape(outcome.spread.covariance, *averaged);
  }
  if (data.mass || data.motion) outcome.spread.covariance = with_errors_of_held(data, solution, outcome);
  if (depends_on_speed(solution)) outcome.other_law = other_law(solution, kind);
  outcome.disagree = recordings_disagree(outcome);
  if (outcome.disagree) {
    Spread& spread = outcome.spread;
    spread.covariance += jackknife_over(outcome.left_out);
    const double fitted =
        solution.recordings.front().solves_for(kStiffnessExponent) ? 2.0 : 1.0;  // of a line, of a mean
    spread.degrees_of_freedom = std::max(1.0, std::min(spread.degrees_of_freedom, count_of(outcome.left_out) - fitted));
  }
  if (outcome.reach.trend) outcome.reach.trend = std::hypot(*outcome.reach.trend, error_beyond(outcome));
  add_cutoff(solution, kind, outcome.spread);
  AlongRate along = profile_rate(solution, kind, outcome.values, outcome.spread);
  outcome.values = along.best;
  outcome.spread = std::move(along.spread);
  return outcome;
}

Spread spread_at(const LeftOut& fit, double speed_m_per_s) {
  Spread spread = fit.spread;
  const double half_width = fit.reach.half_width_at(speed_m_per_s) * fit.values(kDifference);
  const double quantile = t_quantile(spread.degrees_of_freedom);
  spread.covariance(kDifference, kDifference) += std::pow(half_width / quantile, 2);
  const double of_stiffness = fit.values(kStiffnessExponent) * fit.reach.distance_beyond(speed_m_per_s);
  Coordinates growth = Coordinates::Zero();
  growth(kLogStiffness) = of_stiffness / quantile;
  growth(kLogFrequency) = 0.5 * of_stiffness / quantile;  // of the same mass
  spread.covariance += growth * growth.transpose();
  return spread;
}

double left_out_error(const SweepOutcome& outcome) {
  const SweepSolution& solution = outcome.solution;
  double square = 0.0;
  for (std::size_t recording = 0; recording < solution.recordings.size(); ++recording) {
    const double most = std::log(thresholds::kWidestFactor);
    const double error = std::min(most, std::abs(left_out_difference(outcome, recording).value_or(most)));
    square += error * error;
  }
  return std::sqrt(square / static_cast<double>(solution.recordings.size()));
}

double residual_over_noise(std::span<const SweepRecording> recordings, const SweepData& data,
                           const SweepSolution& solution) {
  double sum = 0.0;
  for (const std::size_t i : data.fitted) {
    const double noise = recordings[i].quality.noise_rms;
    if (noise > 0.0) sum += std::pow(data.single[i]->uncertainty.noise / noise, 2);
  }
  return sum / static_cast<double>(data.fitted.size()) * solution.chi2 / solution.degrees_of_freedom;
}

double effect_of_averaging(std::span<const SweepRecording> recordings, const SweepOutcome& outcome,
                           const SweepData& data) {
  const double omega = std::exp(outcome.values(kLogFrequency));
  double variance_s2 = 0.0;
  for (const std::size_t i : data.fitted) {
    const Recording& recording = recordings[i].recording;
    if (recording.conditions().sensor_average_s || data.single[i]->average) continue;
    const double step_s = recording.sample_interval_s();
    variance_s2 += data.rounding_s2.value_or(step_s * step_s / 12.0) / static_cast<double>(data.fitted.size());
  }
  return kFrequencyByAverage * omega * omega * variance_s2;
}

}  // namespace slipfit::fit
