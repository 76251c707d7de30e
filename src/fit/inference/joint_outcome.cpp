#include "fit/inference/joint_outcome.hpp"

#include <algorithm>
#include <cmath>

#include "fit/inference/joint_ageing.hpp"
#include "fit/inference/joint_profile.hpp"

namespace slipfit::fit {
namespace {

/// A recording left out moves a parameter by chance by this many standard errors of the shift in fewer than one sweep
/// of 300 (5 recordings, 7 parameters).
constexpr double kShiftSigmas = 4.5;

/// A line through few recordings counts for fewer than the cycles do.
double degrees_of_freedom(const JointCovariance& covariance, const JointSolution& solution, StaticFriction kind) {
  if (kind == StaticFriction::Constant) return covariance.degrees_of_freedom;
  return std::min(covariance.degrees_of_freedom, std::max(1.0, static_cast<double>(solution.problem->size()) - 2.0));
}

LeftOut leave_out_each(const SweepData& data, const JointSolution& solution, StaticFriction kind) {
  LeftOut result;
  for (const std::size_t recording : data.fitted) {
    result.each.emplace_back();
    const std::optional<JointSolution> without = leave_out(data, solution, recording);
    if (!without) continue;
    const JointCovariance covariance = covariance_of(data, *without);
    result.each.back() = LeftOut::One{sweep_values(*without, kind), sweep_covariance(*without, covariance, kind),
                                      degrees_of_freedom(covariance, *without, kind)};
  }
  return result;
}

/// The recordings disagree by more than noise and the scatter of the cycles explain: the variance of the shift between
/// an efficient estimate and one from fewer data is the difference of their variances (Hausman).
bool recordings_disagree(const SweepVector& values, const SweepMatrix& covariance, const LeftOut& left_out) {
  if (left_out.count() < 3.0) return false;
  for (const auto& one : left_out.each) {
    for (Eigen::Index i = 0; one && i < kSweepValues; ++i) {
      const double least = 0.05 * covariance(i, i);  // rounding and iteration: the difference may come out as nothing
      const double variance = std::max(one->covariance(i, i) - covariance(i, i), least);
      const double shift = one->values(i) - values(i);
      if (variance > 0.0 && shift * shift > kShiftSigmas * kShiftSigmas * variance) return true;
    }
  }
  return false;
}

}  // namespace

SweepMatrix LeftOut::covariance() const {
  SweepVector mean = SweepVector::Zero();
  for (const auto& one : each) {
    if (one) mean += one->values / count();
  }
  SweepMatrix sum = SweepMatrix::Zero();
  for (const auto& one : each) {
    if (one) sum += (count() - 1.0) / count() * (one->values - mean) * (one->values - mean).transpose();
  }
  return sum;
}

double LeftOut::count() const {
  return static_cast<double>(std::count_if(each.begin(), each.end(), [](const auto& one) { return one.has_value(); }));
}

Outcome weigh(const SweepData& data, const JointSolution& solution) {
  const JointCovariance covariance = covariance_of(data, solution);
  const StaticFriction kind = static_friction_of(solution);
  Outcome outcome{solution,
                  kind,
                  sweep_values(solution, kind),
                  sweep_covariance(solution, covariance, kind),
                  degrees_of_freedom(covariance, solution, kind),
                  leave_out_each(data, solution, kind)};
  outcome.disagree = recordings_disagree(outcome.values, outcome.covariance, outcome.left_out);
  if (outcome.disagree) {
    outcome.covariance += outcome.left_out.covariance();
    outcome.degrees_of_freedom = std::min(outcome.degrees_of_freedom, outcome.left_out.count() - 1.0);
  }
  outcome.profile =
      profile_of_rate(data, solution, kind, outcome.values, outcome.covariance, outcome.degrees_of_freedom);
  avoid_negative_damping(outcome.values, outcome.profile);
  return outcome;
}

double left_out_error(const SweepData& data, const Outcome& outcome) {
  double square = 0.0;
  for (std::size_t run = 0; run < data.fitted.size(); ++run) {
    const BlockFit& blocks = outcome.solution.problem->recording(run);
    const double speed = blocks.scales().speed_m_per_s;
    double error = std::log(kWidestFactor);
    if (const auto& one = outcome.left_out.each[run]) {
      const SweepModel model(with_damping_cut(one->values, one->covariance), data.scales);
      const auto spacing = model.spacing(speed, outcome.solution.problem->run(run).load);
      if (spacing) error = std::min(error, std::abs(std::log(spacing->a / (speed * median_period_s(blocks)))));
    }
    square += error * error;
  }
  return std::sqrt(square / static_cast<double>(data.fitted.size()));
}

}  // namespace slipfit::fit
