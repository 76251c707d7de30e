#include "fit/selection/sweep_solution.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "core/quantile.hpp"
#include "fit/inference/covariance.hpp"
#include "fit/problem/solve.hpp"

namespace slipfit::fit {
namespace {

constexpr double kSlowestRate = 0.3;  // alpha v_c with which the search for another law begins
constexpr int kSweepMaxIterations = 50;

/// Residual rows over parameters: each stick bin counts as its two rows, as it does in chi2.
double residual_freedom(const SweepSolution& solution) {
  const CommonColumns columns(solution.problem());
  double freedom = static_cast<double>(columns.held(solution.held).size()) - static_cast<double>(columns.size());
  if (solution.sweep.sharing.level) freedom += static_cast<double>(solution.sweep.steady.size());
  for (const BlockFit& recording : solution.recordings) {
    for (std::size_t c = 0; c < recording.size(); ++c) {
      freedom += static_cast<double>(recording.model(c).residuals()) - static_cast<double>(recording.columns().own());
    }
  }
  return std::max(1.0, freedom);
}

SweepSolution moved_by(SweepSolution solution, const NewtonStep& step) {
  const CommonColumns columns(solution.problem());
  for (std::size_t r = 0; r < solution.recordings.size(); ++r) {
    BlockFit& recording = solution.recordings[r];
    const double time = recording.parameters.values(kSensorTime);
    columns.visit(r, recording, recording.parameters,
                  [&](Eigen::Index column, double& value) { value += step.step(column); });
    constexpr double kMost = 0.5;  // of it, where a step leads to none
    double& moved = recording.parameters.values(kSensorTime);
    moved = std::max(kMost * time, moved);
  }
  solution.chi2 = step.sum_of_squares;
  solution.degrees_of_freedom = residual_freedom(solution);
  return solution;
}

}  // namespace

std::size_t SweepSolution::cycles() const {
  std::size_t count = 0;
  for (const BlockFit& recording : recordings) count += recording.size();
  return count;
}

Coordinates SweepSolution::shared() const {
  Coordinates values = Coordinates::Zero();
  for (const BlockFit& recording : recordings) {
    for (const Coordinate coordinate : recording.columns().coordinates()) {
      if (!is_of_recording(coordinate)) values(coordinate) = recording.parameters.values(coordinate);
    }
  }
  return values;
}

const BlockFit* SweepSolution::with_sensor_time() const {
  const auto has_time = [](const BlockFit& recording) { return recording.solves_for(kSensorTime); };
  const auto found = std::find_if(recordings.begin(), recordings.end(), has_time);
  return found == recordings.end() ? nullptr : &*found;
}

std::vector<double> SweepSolution::speeds_m_per_s() const {
  std::vector<double> speeds;
  for (const BlockFit& recording : recordings) speeds.push_back(recording.scales().speed_m_per_s);
  return speeds;
}

bool SweepSolution::can_show_trend(std::size_t fewest) const {
  return recordings.size() >= fewest && ratio_of_ends(speeds_m_per_s()) > thresholds::kTrendSpeedRatio;
}

double solve(SweepSolution& solution, const Held& held, int max_iterations, double tolerance) {
  return solve_together(solution.recordings, solution.sweep, {held, false, true, max_iterations, tolerance});
}

std::optional<SweepSolution> at_minimum(SweepSolution solution, const Held& held, double tolerance) {
  solution.held = held;
  solution.chi2 = solve(solution, held, kSweepMaxIterations, tolerance);
  if (!std::isfinite(solution.chi2)) return std::nullopt;
  solution.degrees_of_freedom = residual_freedom(solution);
  return solution;
}

SweepSolution settled(const SweepSolution& solution) {
  std::optional<SweepSolution> lower = at_minimum(solution, solution.held);
  return lower && lower->chi2 <= solution.chi2 ? *std::move(lower) : solution;
}

std::optional<SweepSolution> with_rate(const SweepSolution& solution, double rate) {
  SweepSolution moved = solution;
  for (BlockFit& recording : moved.recordings) recording.parameters.values(kFrictionRate) = rate;
  Held held = solution.held;
  held[kFrictionRate] = true;
  return at_minimum(std::move(moved), held);
}

std::optional<SweepSolution> with_law(const SweepSolution& solution, FrictionLaw law) {
  SweepSolution other = solution;
  for (BlockFit& recording : other.recordings) {
    Scales scales = recording.scales();
    scales.law = law;
    recording = recording.with_scales(scales);
    // The other laws have friction that changes ever less.
    double& rate = recording.parameters.values(kFrictionRate);
    rate = std::min(rate, -kSlowestRate);
  }
  return at_minimum(std::move(other), solution.held);
}

std::optional<SweepSolution> with_exponent(SweepSolution solution, const Held& held) {
  for (BlockFit& recording : solution.recordings) {
    Scales scales = recording.scales();
    scales.population->log_speed = std::log(scales.speed_m_per_s / solution.sweep.units.speed_m_per_s);
    recording = recording.with_scales(scales);
  }
  return at_minimum(std::move(solution), held);
}

std::optional<SweepSolution> with_held(const SweepSolution& solution, Coordinate coordinate, double change) {
  SweepSolution other = solution;
  for (BlockFit& recording : other.recordings) recording.parameters.values(coordinate) += change;
  return at_minimum(std::move(other), solution.held);
}

std::optional<SweepSolution> with_motion(SweepSolution solution, const FreeMotion& motion) {
  Held held = solution.held;
  held[kLogFrequency] = held[kDamping] = true;
  for (BlockFit& recording : solution.recordings) {
    recording.parameters.values(kLogFrequency) = motion.values(0);
    recording.parameters.values(kDamping) = motion.values(1);
  }
  return at_minimum(std::move(solution), held);
}

std::optional<NormalSolution> leave_out(const NormalSolution& all, std::size_t recording) {
  constexpr double kSmallGain = 1.0;  // in variances of the residuals: a step within the error of all is good
  const SweepSolution& solution = all.solution;
  if (solution.recordings.size() < 3) return std::nullopt;
  NormalSolution others{solution, {}};
  others.solution.recordings.erase(others.solution.recordings.begin() + static_cast<std::ptrdiff_t>(recording));
  others.normals = normals_without(solution.problem(), recording, all.normals, others.solution.problem());
  const NewtonStep step = newton_step(others.solution.problem(), others.normals, solution.held);
  const double variance = std::max(1.0, solution.chi2 / solution.degrees_of_freedom);
  if (step.step.allFinite() && step.gain < kSmallGain * variance) {
    others.solution = moved_by(std::move(others.solution), step);
    return others;
  }
  std::optional<SweepSolution> refitted = at_minimum(std::move(others.solution), solution.held);
  if (!refitted) return std::nullopt;
  others.solution = *std::move(refitted);
  others.normals = normals_of(others.solution.problem());
  return others;
}

}  // namespace slipfit::fit
