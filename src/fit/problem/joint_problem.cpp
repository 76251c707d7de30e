#include "fit/problem/joint_problem.hpp"

#include <ceres/ceres.h>

#include <cmath>
#include <limits>
#include <utility>

#include "fit/problem/solver_log.hpp"

namespace slipfit::fit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Parameter blocks: shared, level, difference, [drift,] own.
class JointCost : public ceres::CostFunction {
 public:
  explicit JointCost(const JointCycle& cycle) : cycle_(cycle), has_drift_(cycle.drift_parameters() > 0) {
    set_num_residuals(static_cast<int>(cycle.residuals()));
    for (const std::size_t size : {kJointShared + 0, std::size_t{1}, std::size_t{1}}) {
      mutable_parameter_block_sizes()->push_back(static_cast<int>(size));
    }
    if (has_drift_) mutable_parameter_block_sizes()->push_back(static_cast<int>(cycle.drift_parameters()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(cycle.own_parameters()));
  }

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    const std::size_t own = has_drift_ ? 4 : 3;
    const JointValues values{parameters[0], parameters[1], parameters[2], has_drift_ ? parameters[3] : nullptr,
                             parameters[own]};
    JointJacobians out;
    if (jacobians != nullptr) {
      out = {jacobians[0], jacobians[1], jacobians[2], has_drift_ ? jacobians[3] : nullptr, jacobians[own]};
    }
    return cycle_.evaluate(values, residuals, out);
  }

 private:
  const JointCycle& cycle_;
  bool has_drift_;
};

/// Parameter blocks: shared, level.
class SteadyCost : public ceres::SizedCostFunction<1, kJointShared, 1> {
 public:
  SteadyCost(const JointProblem& problem, const SteadyRun& run) : problem_(problem), run_(run) {}

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    const JointProblem::SteadyResidual steady = problem_.steady_residual(run_, parameters[0], *parameters[1]);
    if (!std::isfinite(steady.value)) return false;
    residuals[0] = steady.value;
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) std::copy(steady.d_shared.begin(), steady.d_shared.end(), jacobians[0]);
    if (jacobians[1] != nullptr) *jacobians[1] = steady.d_level;
    return true;
  }

 private:
  const JointProblem& problem_;
  const SteadyRun& run_;
};

void hold(ceres::Problem& problem, double* shared, const JointHeld& held) {
  std::vector<int> constant;
  for (std::size_t i = 0; i < kJointShared; ++i) {
    if (held[i]) constant.push_back(static_cast<int>(i));
  }
  if (constant.size() == kJointShared) {
    problem.SetParameterBlockConstant(shared);
  } else if (!constant.empty()) {
    problem.SetManifold(shared, new ceres::SubsetManifold(static_cast<int>(kJointShared), constant));
  }
}

ceres::Solver::Options solver_options(int max_iterations, double function_tolerance) {
  ceres::Solver::Options options;
  options.max_num_iterations = max_iterations;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.function_tolerance = function_tolerance;
  options.gradient_tolerance = 1e-14;
  options.parameter_tolerance = 1e-11;
  options.max_num_consecutive_invalid_steps = 20;  // a step into friction that runs away: shorten it
  options.logging_type = ceres::SILENT;
  return options;
}

}  // namespace

JointProblem::JointProblem(std::vector<const BlockFit*> recordings, std::vector<JointRun> runs,
                           std::vector<SteadyRun> steady, JointScales scales, Shares shares)
    : recordings_(std::move(recordings)),
      runs_(std::move(runs)),
      steady_(std::move(steady)),
      scales_(scales),
      shares_(shares),
      cycles_(runs_.size()) {
  parameters.levels.assign(shares.level ? 1 : runs_.size(), 0.0);
  parameters.differences.assign(shares.difference ? 1 : runs_.size(), 0.0);
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const BlockFit& recording = *recordings_[r];
    cycles_[r].reserve(recording.size());
    for (std::size_t c = 0; c < recording.size(); ++c) {
      cycles_[r].emplace_back(recording.model(c), recording.level(), recording.reference_s(c), runs_[r], scales_);
    }
    parameters.drifts.emplace_back(cycles_[r].front().drift_parameters(), 0.0);
    parameters.cycles.push_back(recording.parameters.cycles);
  }
}

double JointProblem::solve(const JointHeld& held, int max_iterations, double tolerance) {
  silence_solver_log();
  ceres::Problem problem;
  double* shared = parameters.shared.data();
  // Inside a group Ceres orders blocks by their address: cycles stand in one array and every other block is a group, so
  // that the same input gives the same rounding.
  std::vector<Own> owns;
  for (const std::vector<Own>& run : parameters.cycles) owns.insert(owns.end(), run.begin(), run.end());
  std::size_t next = 0;
  int group = 1;
  auto* ordering = new ceres::ParameterBlockOrdering;
  std::size_t residuals = 0;
  for (std::size_t r = 0; r < size(); ++r) {
    double* level = &parameters.levels[shares_.level ? 0 : r];
    double* difference = &parameters.differences[shares_.difference ? 0 : r];
    double* drift = parameters.drifts[r].empty() ? nullptr : parameters.drifts[r].data();
    for (const JointCycle& cycle : cycles_[r]) {
      double* own = owns[next++].data();
      std::vector<double*> blocks{shared, level, difference};
      if (drift != nullptr) blocks.push_back(drift);
      blocks.push_back(own);
      // A cycle far worse than the others counts linearly, not squared.
      const auto rows = static_cast<double>(cycle.residuals());
      problem.AddResidualBlock(new JointCost(cycle), new ceres::HuberLoss(3.0 * std::sqrt(rows)), blocks);
      ordering->AddElementToGroup(own, 0);
      residuals += cycle.residuals();
    }
    for (double* block : {level, difference, drift}) {
      if (block != nullptr && !ordering->IsMember(block)) ordering->AddElementToGroup(block, group++);
    }
  }
  ordering->AddElementToGroup(shared, group);
  for (std::size_t i = 0; shares_.level && i < steady_.size(); ++i) {
    problem.AddResidualBlock(new SteadyCost(*this, steady_[i]), nullptr, shared, parameters.levels.data());
  }
  hold(problem, shared, held);
  ceres::Solver::Options options = solver_options(max_iterations, tolerance / static_cast<double>(residuals));
  options.linear_solver_ordering.reset(ordering);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  next = 0;
  for (std::vector<Own>& run : parameters.cycles) {
    for (Own& own : run) own = owns[next++];
  }
  if (!summary.IsSolutionUsable()) return std::numeric_limits<double>::infinity();
  return 2.0 * summary.final_cost;
}

std::size_t JointProblem::cycle_count() const {
  std::size_t count = 0;
  for (const auto& run : cycles_) count += run.size();
  return count;
}

JointValues JointProblem::values(std::size_t run, std::size_t cycle) const {
  return {parameters.shared.data(), &parameters.levels[shares_.level ? 0 : run],
          &parameters.differences[shares_.difference ? 0 : run], parameters.drifts[run].data(),
          parameters.cycles[run][cycle].data()};
}

double JointProblem::rows() const {
  std::size_t rows = shares_.level ? steady_.size() : 0;
  for (const auto& run : cycles_) {
    for (const JointCycle& cycle : run) rows += cycle.residuals();
  }
  return static_cast<double>(rows);
}

std::size_t JointProblem::level_column(std::size_t run) const {
  return kJointShared + (shares_.level ? 0 : run);
}

std::size_t JointProblem::difference_column(std::size_t run) const {
  return kJointShared + parameters.levels.size() + (shares_.difference ? 0 : run);
}

std::size_t JointProblem::drift_column(std::size_t run) const {
  std::size_t column = kJointShared + parameters.levels.size() + parameters.differences.size();
  for (std::size_t r = 0; r < run; ++r) column += parameters.drifts[r].size();
  return column;
}

std::size_t JointProblem::columns() const {
  return drift_column(size());
}

JointProblem::Normal JointProblem::normal_of(std::size_t run, std::size_t cycle) const {
  const JointCycle& model = cycles_[run][cycle];
  const auto rows = static_cast<Index>(model.residuals());
  const auto drifts = static_cast<Index>(model.drift_parameters());
  VectorXd residuals(rows);
  RowMajor shared(rows, static_cast<Index>(kJointShared));
  RowMajor drift(rows, drifts);
  RowMajor own(rows, static_cast<Index>(model.own_parameters()));
  VectorXd level(rows);
  VectorXd difference(rows);
  model.evaluate(values(run, cycle), residuals.data(),
                 {shared.data(), level.data(), difference.data(), drifts > 0 ? drift.data() : nullptr, own.data()});
  MatrixXd common = MatrixXd::Zero(rows, static_cast<Index>(columns()));
  common.leftCols(static_cast<Index>(kJointShared)) = shared;
  common.col(static_cast<Index>(level_column(run))) = level;
  common.col(static_cast<Index>(difference_column(run))) = difference;
  common.middleCols(static_cast<Index>(drift_column(run)), drifts) = drift;
  const MatrixXd cross = common.transpose() * own;
  const MatrixXd response = -(own.transpose() * own).ldlt().solve(cross.transpose());
  return {common.transpose() * common + cross * response,
          common.transpose() * residuals + response.transpose() * (own.transpose() * residuals)};
}

JointProblem::Normal JointProblem::normal_of(const SteadyRun& run) const {
  const SteadyResidual steady = steady_residual(run, parameters.shared.data(), parameters.levels.front());
  VectorXd row = VectorXd::Zero(static_cast<Index>(columns()));
  for (std::size_t i = 0; i < kJointShared; ++i) row(static_cast<Index>(i)) = steady.d_shared[i];
  row(static_cast<Index>(level_column(0))) = steady.d_level;
  return {row * row.transpose(), row * steady.value};
}

std::vector<JointProblem::Normal> JointProblem::normals() const {
  std::vector<Normal> normals;
  for (std::size_t r = 0; r < size(); ++r) {
    for (std::size_t c = 0; c < cycles_[r].size(); ++c) normals.push_back(normal_of(r, c));
  }
  for (std::size_t i = 0; shares_.level && i < steady_.size(); ++i) normals.push_back(normal_of(steady_[i]));
  return normals;
}

/// F_k(V) = F_k(0+) + G expm1(alpha V) / expm1(alpha v_c), G = 2 v_c sqrt(k m) times kFrictionSlope. docs/model.md
/// section 5
JointProblem::SteadyResidual JointProblem::steady_residual(const SteadyRun& run, const double* shared,
                                                           double level) const {
  const double a = shared[kFrictionRate];
  const double speed = run.speed_m_per_s / scales_.slip_speed_m_per_s;
  const SlopeRatio whole = slope_ratio(a);
  const SlopeRatio part = slope_ratio(a * speed);
  const double growth = speed * whole.value / part.value;  // expm1(a speed) / expm1(a)
  const double d_growth =
      speed * (whole.derivative / part.value - whole.value * part.derivative * speed / (part.value * part.value));
  const double weight = 1.0 / run.standard_error;
  const double impedance = std::exp(shared[kJointStiffness] - shared[kJointFrequency]);  // sqrt(k m)
  const double unit = 2.0 * run.load * scales_.slip_speed_m_per_s * impedance;
  const double excess = unit * shared[kFrictionSlope] * growth;
  SteadyResidual result;
  result.value = weight * (run.mean_force - run.load * scales_.force * level - excess);
  result.d_level = -weight * run.load * scales_.force;
  result.d_shared[kJointStiffness] = -weight * excess;
  result.d_shared[kJointFrequency] = weight * excess;
  result.d_shared[kFrictionSlope] = -weight * unit * growth;
  result.d_shared[kFrictionRate] = -weight * unit * shared[kFrictionSlope] * d_growth;
  return result;
}

}  // namespace slipfit::fit
