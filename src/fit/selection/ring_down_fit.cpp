#include "fit/selection/ring_down_fit.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/statistics.hpp"
#include "core/thresholds.hpp"
#include "fit/inference/smoothing.hpp"
#include "fit/problem/solve.hpp"
#include "fit/selection/average_term.hpp"
#include "fit/selection/rise.hpp"
#include "fit/selection/solution.hpp"
#include "fit/selection/term_fitter.hpp"

namespace slipfit::fit {
namespace {

/// Returns how far averaging that is neither stated by the user nor part of the fit may move ln w_n.
double off_by_averaging(const Recording& recording, const DampedFit& fit) {
  if (recording.conditions().sensor_average_s || fit.average) return 0.0;
  const Smoothing seen = fit.rounding.value_or(Smoothing{});
  const double omega = std::exp(fit.blocks.parameters.values(kLogFrequency));
  return kFrequencyByAverage * omega * omega * unstated_variance_s2(fit, seen, recording.sample_interval_s());
}

/// Converts a ring-down at a speed to the mean of the speeds, by the dependence of k on the speed.
FreeMotion at_mean_speed(FreeMotion ring, double speed_m_per_s, const SweepOutcome& outcome) {
  const double log_ratio = std::log(speed_m_per_s / outcome.solution.sweep.units.speed_m_per_s);
  const double exponent = outcome.values(kStiffnessExponent);
  ring.values(0) -= 0.5 * exponent * log_ratio;
  const double variance = outcome.spread.with_scatter()(kStiffnessExponent, kStiffnessExponent);
  // It may end there, or double: no more is as unlikely as the ends of the interval.
  const double beyond = exponent * outcome.reach.distance_beyond(speed_m_per_s);
  const double beyond_error = beyond / t_quantile(outcome.spread.degrees_of_freedom);
  ring.covariance(0, 0) += 0.25 * (variance * log_ratio * log_ratio + beyond_error * beyond_error);
  return ring;
}

/// Mean by their errors, which are larger where the motions scatter by more.
FreeMotion mean_of(const std::vector<FreeMotion>& motions) {
  Eigen::Matrix2d weights = Eigen::Matrix2d::Zero();
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const FreeMotion& motion : motions) {
    weights += motion.covariance.inverse();
    sum += motion.covariance.inverse() * motion.values;
  }
  FreeMotion mean{weights.inverse() * sum, weights.inverse()};
  double chi2 = 0.0;
  for (const FreeMotion& motion : motions) {
    const Eigen::Vector2d apart = motion.values - mean.values;
    chi2 += apart.dot(motion.covariance.inverse() * apart);
  }
  const double freedom = 2.0 * (static_cast<double>(motions.size()) - 1.0);
  if (freedom > 0.0) mean.covariance *= std::max(1.0, chi2 / freedom);
  return mean;
}

/// Returns the fit with the errors of w_n and zeta, which are held at `motion`, in its covariance.
std::optional<DampedFit> with_errors_of(const FreeMotion& motion, DampedFit fit) {
  MotionMoves moves;
  for (const Coordinate i : {kLogFrequency, kDamping}) {
    const std::optional<Coordinates> move = moves_by(fit, i);
    if (!move) return std::nullopt;
    moves.col(i - kLogFrequency) = *move;
  }
  fit.uncertainty.covariance = with_motion(fit.uncertainty.covariance, moves, motion);
  if (const auto average = average_of(fit.blocks, fit.uncertainty.covariance)) fit.average = average;
  fit.motion = motion;
  return fit;
}

}  // namespace

std::optional<RingEvidence> ring_evidence(const Recording& recording, const DampedFit& fit, const RingDown& ring) {
  if (fit.held[kLogFrequency] || fit.held[kDamping]) return std::nullopt;  // by the user, or zeta is refused
  const FreeMotion slips =
      motion_of_slips(coordinates_of(fit.blocks), fit.uncertainty.covariance, off_by_averaging(recording, fit));
  const FreeMotion rings = motion_of(ring, fit.uncertainty.degrees_of_freedom);
  const SameMotion same = compare_motions(slips, rings);
  if (same.differs && !fit.fall_caveat.empty()) return std::nullopt;
  return RingEvidence{slips, rings, same};
}

std::optional<RingEvidence> ring_evidence(std::span<const SweepRecording> recordings, const SweepData& data,
                                          const SweepOutcome& outcome) {
  const SweepSolution& solution = outcome.solution;
  const bool is_coulomb = solution.recordings.front().scales().law == FrictionLaw::Coulomb;
  if (!is_coulomb) return std::nullopt;
  std::vector<FreeMotion> rings;
  for (const SweepRecording& sweep : recordings) {
    if (!sweep.ring_down) continue;
    const FreeMotion ring = motion_of(*sweep.ring_down, outcome.spread.degrees_of_freedom);
    rings.push_back(at_mean_speed(ring, sweep.recording.conditions().speed_m_per_s, outcome));
  }
  if (rings.empty()) return std::nullopt;
  const double off = effect_of_averaging(recordings, outcome, data);
  const FreeMotion mean = mean_of(rings);
  FreeMotion slips = motion_of_slips(outcome.values, outcome.spread.with_scatter(), off);
  if (solution.held[kDamping]) {
    const auto at_ring_damping = with_held(solution, kDamping, mean.values(1) - outcome.values(kDamping));
    if (!at_ring_damping) return std::nullopt;
    const SweepOutcome given = outcome_of(data, *at_ring_damping);
    slips = motion_of_slips(given.values, given.spread.with_scatter(), off);
    slips.covariance(1, 1) = 1.0 / 12.0;  // anything between 0 and 1 is as likely
  }
  return RingEvidence{slips, mean, compare_motions(slips, mean)};
}

std::optional<Warning> join_ring_downs(std::span<const SweepRecording> recordings, const HeldParameters& held,
                                       SweepData& data, SweepOutcome& outcome) {
  if (held.natural_frequency_rad_per_s || held.damping_ratio) return std::nullopt;
  const std::optional<RingEvidence> evidence = ring_evidence(recordings, data, outcome);
  if (!evidence) return std::nullopt;
  if (evidence->same.differs) return differing_motions(evidence->slips, evidence->rings);
  if (!evidence->same.both) return std::nullopt;
  const std::optional<SweepSolution> informed = with_motion(outcome.solution, *evidence->same.both);
  if (!informed) return std::nullopt;
  data.motion = evidence->same.both;
  outcome = outcome_of(data, *informed);
  return std::nullopt;
}

std::optional<DampedFit> held_at(const FreeMotion& motion, const FitInput& input, DampedFit fit) {
  fit.held[kLogFrequency] = fit.held[kDamping] = true;
  fit.blocks.parameters.values(kLogFrequency) = motion.values(0);
  fit.blocks.parameters.values(kDamping) = motion.values(1);
  fit.continuous = false;
  if (!std::isfinite(solve(fit.blocks, {fit.held, false}))) return std::nullopt;
  const bool averaged = fit.average.has_value();
  std::optional<DampedFit> next = finish_settled(input, std::move(fit));
  if (!next) return next;
  if (averaged) next = with_average_error(*std::move(next));
  if (next->rounding) {
    next->rounding = estimate_smoothing(next->blocks, next->held, input.recording.sample_interval_s());
  }
  return with_errors_of(motion, *std::move(next));
}

}  // namespace slipfit::fit
