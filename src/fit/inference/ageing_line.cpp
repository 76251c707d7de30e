#include "fit/inference/ageing_line.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <optional>

#include "core/fit_thresholds.hpp"
#include "fit/inference/sliding_model.hpp"

namespace slipfit::fit {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

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

bool can_show_trend(const VectorXd& log_speeds) {
  return static_cast<std::size_t>(log_speeds.size()) >= thresholds::kTrendRecordings &&
         log_speeds.maxCoeff() - log_speeds.minCoeff() > std::log(thresholds::kAgeingSpeedRatio);
}

/// Squared standard errors of the recordings' own F_s - F_k(0+), in its unit: by the scatter over their cycles.
VectorXd own_variances(const SweepSolution& solution) {
  VectorXd variances(static_cast<Index>(solution.recordings.size()));
  for (Index i = 0; i < variances.size(); ++i) {
    const auto recording = static_cast<std::size_t>(i);
    const Population& population = solution.population(recording);
    const auto cycles = static_cast<double>(solution.recordings[recording].size());
    variances(i) = std::pow(population.onset_sd / population.force, 2) / cycles;
  }
  return variances;
}

/// Of the residuals of a line with two parameters.
bool within_own_errors(const VectorXd& residuals, const VectorXd& variances) {
  if (residuals.size() < 3) return true;
  const boost::math::chi_squared_distribution<double> by_chance(static_cast<double>(residuals.size()) - 2.0);
  const double sum = (residuals.array().square() / variances.array()).sum();
  return sum < boost::math::quantile(by_chance, 1.0 - thresholds::kAgeingChance);
}

/// A straight line of least squares over ln V.
struct Line {
  double slope = 0.0;
  double slope_error = 0.0;  ///< by the residuals; 0 for two points
  VectorXd residuals;
};

Line line_over(VectorXd log_speeds, const VectorXd& values) {
  log_speeds.array() -= log_speeds.mean();
  Line line;
  line.slope = log_speeds.dot(values) / log_speeds.squaredNorm();
  line.residuals = values.array() - values.mean() - line.slope * log_speeds.array();
  const double freedom = static_cast<double>(values.size()) - 2.0;
  if (freedom > 0.0) {
    line.slope_error = std::sqrt(line.residuals.squaredNorm() / freedom / log_speeds.squaredNorm());
  }
  return line;
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
  line.explains = within_own_errors(residuals, own_variances(solution));
  line.residual_variance = residuals.squaredNorm() / std::max(1.0, count - 2.0);
  return line;
}

StaticFriction static_friction_of(const SweepSolution& solution) {
  const VectorXd differences = differences_of(solution);
  const VectorXd speeds = log_speeds(solution);
  if (solution.sweep.sharing.difference || !can_show_trend(speeds)) return StaticFriction::Constant;
  const Line line = line_over(speeds, differences);
  if (!(line.slope < 0.0)) return StaticFriction::Constant;
  if (within_own_errors(line.residuals, own_variances(solution))) return StaticFriction::Ages;
  const boost::math::students_t_distribution<double> by_chance(static_cast<double>(differences.size()) - 2.0);
  const double least = boost::math::quantile(by_chance, 1.0 - thresholds::kAgeingChance) * line.slope_error;
  return -line.slope > least ? StaticFriction::Ages : StaticFriction::Constant;
}

SpeedReach reach_of(const SweepSolution& solution) {
  const VectorXd speeds = log_speeds(solution);
  SpeedReach reach{std::exp(speeds.minCoeff()), std::exp(speeds.maxCoeff()), std::nullopt};
  if (!can_show_trend(speeds)) return reach;
  if (solution.sweep.sharing.difference) {
    const double sum = (speeds.array() - speeds.mean()).square().sum();
    const double slope_error =
        std::sqrt(own_variances(solution).mean() / sum) / std::abs(differences_of(solution).mean());
    const double chance = 1.0 / (1.0 + std::sqrt(static_cast<double>(solution.cycles())));
    constexpr double kNormal = 1.959963985;
    // The slope that would be seen by chance, and its own error, are of the same size.
    reach.trend = kNormal * std::sqrt(2.0 * chance) * slope_error;
    return reach;
  }
  const VectorXd differences = differences_of(solution);
  const Line line = line_over(speeds, differences);
  reach.trend = std::hypot(line.slope, 2.0 * line.slope_error) / std::abs(differences.mean());
  return reach;
}

}  // namespace slipfit::fit
