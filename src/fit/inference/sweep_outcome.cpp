#include "fit/inference/sweep_outcome.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/fit_thresholds.hpp"
#include "fit/inference/ageing_line.hpp"
#include "fit/inference/rate_profile.hpp"
#include "fit/inference/sliding_model.hpp"

namespace slipfit::fit {
namespace {

std::vector<std::optional<LeftOut>> leave_out_each(const SweepData& data, const SweepSolution& solution,
                                                   StaticFriction kind) {
  std::vector<std::optional<LeftOut>> each;
  for (std::size_t recording = 0; recording < solution.recordings.size(); ++recording) {
    each.emplace_back();
    if (data.tell_step) {
      data.tell_step(fmt::format("fitting without recording {} of {}", recording + 1, solution.recordings.size()));
    }
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
      if (variance > 0.0 && shift * shift > thresholds::kShiftSigmas * thresholds::kShiftSigmas * variance) return true;
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
    double error = std::log(thresholds::kWidestFactor);
    if (const auto& one = outcome.left_out[recording]) {
      const SlidingModel model(with_damping_cut(one->values, one->spread.covariance), solution.sweep.units);
      const auto spacing = model.spacing(speed, solution.population(recording).load);
      if (spacing) error = std::min(error, std::abs(std::log(spacing->a / (speed * median_period_s(blocks)))));
    }
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
  constexpr double kByVariance = 0.62;  // d ln w_n / d (w_n sigma)^2 of damped slips, sigma^2 that of the average
  const double omega = std::exp(outcome.values(kLogFrequency));
  double sum = 0.0;
  for (const std::size_t i : data.fitted) {
    const Recording& recording = recordings[i].recording;
    if (recording.conditions().sensor_average_s) continue;
    sum += kByVariance * std::pow(omega * recording.sample_interval_s(), 2) / 12.0;
  }
  return sum / static_cast<double>(data.fitted.size());
}

}  // namespace slipfit::fit
