#include "fit/inference/ageing_line.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "core/fit_thresholds.hpp"
#include "fit/inference/sliding_model.hpp"

namespace slipfit::fit {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kLeastRecordings = 4;

VectorXd log_speeds(const SweepSolution& solution) {
  VectorXd logs(static_cast<Index>(solution.recordings.size()));
  for (Index i = 0; i < logs.size(); ++i) {
    logs(i) = std::log(solution.recordings[static_cast<std::size_t>(i)].scales().speed_m_per_s);
  }
  return logs;
}

/// ln(stick / Units::stick_s) of the limit cycle with each recording's own F_s - F_k(0+). Where that does not stick,
/// from the straight ramp over twice F_s - F_k.
VectorXd log_sticks(const SweepSolution& solution) {
  const VectorXd differences = differences_of(solution);
  const Globals& globals = solution.recordings.front().parameters.globals;
  const Units& units = solution.sweep.units;
  Coordinates values = Coordinates::Zero();
  for (std::size_t i = 0; i < globals.size(); ++i) values(static_cast<Index>(i)) = globals[i];
  const SlidingModel model(values, units);
  VectorXd logs(differences.size());
  for (Index i = 0; i < differences.size(); ++i) {
    const auto recording = static_cast<std::size_t>(i);
    const double speed = solution.recordings[recording].scales().speed_m_per_s;
    const double load = solution.population(recording).load;
    const double difference_N = units.force * differences(i);
    const auto cycle = model.cycle(speed, load, Jet(difference_N));
    const double ramp_s = 2.0 * load * std::abs(difference_N) / (model.stiffness.a * speed);
    logs(i) = std::log((cycle && cycle->stick_s.a > 0.0 ? cycle->stick_s.a : ramp_s) / units.stick_s);
  }
  return logs;
}

}  // namespace

VectorXd differences_of(const SweepSolution& solution) {
  VectorXd differences(static_cast<Index>(solution.recordings.size()));
  for (Index i = 0; i < differences.size(); ++i) {
    differences(i) = solution.recordings[static_cast<std::size_t>(i)].parameters.difference;
  }
  return differences;
}

AgeingLine ageing_line(const SweepSolution& solution) {
  const VectorXd differences = differences_of(solution);
  const VectorXd sticks = log_sticks(solution);
  VectorXd instrument = log_speeds(solution);
  instrument.array() -= instrument.mean();
  const auto count = static_cast<double>(differences.size());
  AgeingLine line;
  line.rate_weights = instrument / instrument.dot(sticks);
  line.difference_weights = VectorXd::Constant(differences.size(), 1.0 / count) - sticks.mean() * line.rate_weights;
  const VectorXd residuals = differences.array() - line.difference_weights.dot(differences) -
                             line.rate_weights.dot(differences) * sticks.array();
  line.residual_variance = residuals.squaredNorm() / std::max(1.0, count - 2.0);
  return line;
}

StaticFriction static_friction_of(const SweepSolution& solution) {
  const VectorXd differences = differences_of(solution);
  VectorXd speeds = log_speeds(solution);
  if (solution.sweep.sharing.difference || differences.size() < kLeastRecordings ||
      !(speeds.maxCoeff() - speeds.minCoeff() > std::log(thresholds::kAgeingSpeedRatio))) {
    return StaticFriction::Constant;
  }
  speeds.array() -= speeds.mean();
  const double slope = speeds.dot(differences) / speeds.squaredNorm();
  const VectorXd residuals = differences.array() - differences.mean() - slope * speeds.array();
  const double freedom = static_cast<double>(differences.size()) - 2.0;
  const double error = std::sqrt(residuals.squaredNorm() / freedom / speeds.squaredNorm());
  const boost::math::students_t_distribution<double> by_chance(freedom);
  const bool falls = slope < -boost::math::quantile(by_chance, 1.0 - thresholds::kAgeingChance) * error;
  return falls ? StaticFriction::Ages : StaticFriction::Constant;
}

}  // namespace slipfit::fit
