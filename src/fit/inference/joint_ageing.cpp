#include "fit/inference/joint_ageing.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace slipfit::fit {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kLeastRecordings = 4;
/// Below it speeds hardly move the logarithm of the stick time.
constexpr double kLeastSpeedRatio = 2.0;
constexpr double kChance = 0.01;

VectorXd differences_of(const JointSolution& solution) {
  const std::vector<double>& own = solution.problem->parameters.differences;
  return Eigen::Map<const VectorXd>(own.data(), static_cast<Index>(own.size()));
}

VectorXd log_speeds(const JointSolution& solution) {
  VectorXd logs(static_cast<Index>(solution.problem->size()));
  for (Index i = 0; i < logs.size(); ++i) {
    logs(i) = std::log(solution.problem->run(static_cast<std::size_t>(i)).scales.speed_m_per_s);
  }
  return logs;
}

/// ln(stick / JointScales::stick_s) of the limit cycle with each recording's own F_s - F_k(0+). Where that does not
/// stick, from the straight ramp over twice F_s - F_k.
VectorXd log_sticks(const JointSolution& solution) {
  const JointProblem& problem = *solution.problem;
  const VectorXd differences = differences_of(solution);
  SweepVector values = SweepVector::Zero();
  for (std::size_t i = 0; i < kJointShared; ++i) values(static_cast<Index>(i)) = problem.parameters.shared[i];
  const SweepModel model(values, problem.scales());
  VectorXd logs(differences.size());
  for (Index i = 0; i < differences.size(); ++i) {
    const JointRun& run = problem.run(static_cast<std::size_t>(i));
    const double difference_N = problem.scales().force * differences(i);
    const auto cycle = model.cycle(run.scales.speed_m_per_s, run.load, SweepJet(difference_N));
    const double ramp_s = 2.0 * run.load * std::abs(difference_N) / (model.stiffness.a * run.scales.speed_m_per_s);
    logs(i) = std::log((cycle && cycle->stick_s.a > 0.0 ? cycle->stick_s.a : ramp_s) / problem.scales().stick_s);
  }
  return logs;
}

}  // namespace

AgeingLine ageing_line(const JointSolution& solution) {
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

StaticFriction static_friction_of(const JointSolution& solution) {
  const VectorXd differences = differences_of(solution);
  VectorXd speeds = log_speeds(solution);
  if (solution.problem->shares().difference || differences.size() < kLeastRecordings ||
      !(speeds.maxCoeff() - speeds.minCoeff() > std::log(kLeastSpeedRatio))) {
    return StaticFriction::Constant;
  }
  speeds.array() -= speeds.mean();
  const double slope = speeds.dot(differences) / speeds.squaredNorm();
  const VectorXd residuals = differences.array() - differences.mean() - slope * speeds.array();
  const double freedom = static_cast<double>(differences.size()) - 2.0;
  const double error = std::sqrt(residuals.squaredNorm() / freedom / speeds.squaredNorm());
  const boost::math::students_t_distribution<double> by_chance(freedom);
  const bool falls = slope < -boost::math::quantile(by_chance, 1.0 - kChance) * error;
  return falls ? StaticFriction::Ages : StaticFriction::Constant;
}

}  // namespace slipfit::fit
