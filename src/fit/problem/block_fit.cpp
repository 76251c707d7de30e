#include "fit/problem/block_fit.hpp"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "fit/problem/reduced_rows.hpp"
#include "fit/problem/solver_log.hpp"

namespace slipfit::fit {
namespace {

/// Parameter blocks: shared, [level,] own. The cycle's rows are reduced to one a parameter and one more, which must not
/// be asked of two threads at a time.
class CycleCost : public ceres::CostFunction {
 public:
  explicit CycleCost(const CycleModel& model)
      : model_(model),
        residuals_(model.residuals()),
        jacobian_(model.residuals(), model.columns()),
        reduced_(model.columns() + 1, model.columns() + 1) {
    set_num_residuals(static_cast<int>(model.columns() + 1));
    for (const std::size_t size : {kShared, model.level_parameters(), model.own_parameters()}) {
      if (size > 0) mutable_parameter_block_sizes()->push_back(static_cast<int>(size));
    }
  }

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    const bool has_level = model_.level_parameters() > 0;
    const double* level = has_level ? parameters[1] : nullptr;
    const double* own = parameters[has_level ? 2 : 1];
    double* jacobian = jacobians != nullptr ? jacobian_.data() : nullptr;
    if (!model_.evaluate(parameters[0], level, own, residuals_.data(), jacobian)) return false;
    if (jacobians == nullptr) {
      std::fill_n(residuals, num_residuals(), 0.0);
      residuals[0] = residuals_.norm();
    } else {
      reduce_rows(jacobian_, residuals_, reduced_);
      put_reduced(residuals, jacobians);
    }
    return true;
  }

 private:
  void put_reduced(double* residuals, double** jacobians) const {
    Eigen::Map<Eigen::VectorXd>(residuals, reduced_.rows()) = reduced_.rightCols<1>();
    Eigen::Index column = 0;
    for (const int size : parameter_block_sizes()) {
      if (*jacobians != nullptr)
        Eigen::Map<RowMajor>(*jacobians, reduced_.rows(), size) = reduced_.middleCols(column, size);
      column += size;
      ++jacobians;
    }
  }

  const CycleModel& model_;
  mutable Eigen::VectorXd residuals_;
  mutable Eigen::MatrixXd jacobian_;
  mutable RowMajor reduced_;
};

/// Parameter blocks: shared, own of the first cycle, own of the second.
class RampCost : public ceres::SizedCostFunction<1, 3, 2, 2> {
 public:
  RampCost(const BlockFit& fit, std::size_t first) : fit_(fit), first_(first) {}

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    const RampResidual ramp = ramp_residual(fit_, first_, parameters[0], parameters[1], parameters[2]);
    if (!std::isfinite(ramp.value)) return false;
    residuals[0] = ramp.value;
    if (jacobians == nullptr) return true;
    const auto copy = [](const auto& from, double* to) {
      if (to != nullptr) std::copy(from.begin(), from.end(), to);
    };
    copy(ramp.d_shared, jacobians[0]);
    copy(ramp.d_first, jacobians[1]);
    copy(ramp.d_second, jacobians[2]);
    return true;
  }

 private:
  const BlockFit& fit_;
  std::size_t first_;
};

void hold(ceres::Problem& problem, double* shared, const Held& held) {
  std::vector<int> constant;
  if (held.stiffness) constant.push_back(0);
  if (held.frequency) constant.push_back(1);
  if (held.damping) constant.push_back(2);
  if (constant.size() == kShared) {
    problem.SetParameterBlockConstant(shared);
  } else if (!constant.empty()) {
    problem.SetManifold(shared, new ceres::SubsetManifold(static_cast<int>(kShared), constant));
  }
}

ceres::Solver::Options solver_options(const SolveOptions& options, std::size_t residuals) {
  ceres::Solver::Options solver;
  solver.max_num_iterations = options.max_iterations;
  // Continuity couples neighbouring cycles: a banded matrix with a border instead of independent blocks.
  solver.linear_solver_type = options.continuous ? ceres::SPARSE_NORMAL_CHOLESKY : ceres::DENSE_SCHUR;
  // Damped steps move a long chain of joined cycles only a part of the way (23 steps at 5000 cycles, 4 undamped); it
  // starts at the solution for the cycles by themselves.
  if (options.continuous) solver.initial_trust_region_radius = 1e10;
  solver.function_tolerance = options.tolerance / static_cast<double>(residuals);
  solver.gradient_tolerance = 1e-14;
  solver.parameter_tolerance = 1e-11;
  solver.logging_type = ceres::SILENT;
  solver.num_threads = 1;
  return solver;
}

}  // namespace

RampResidual ramp_residual(const BlockFit& fit, std::size_t first, const double* shared, const double* own_first,
                           const double* own_second) {
  const Scales& scales = fit.scales();
  CycleState s;
  if (!fit.model(first).state(shared, own_first, s)) return {std::numeric_limits<double>::quiet_NaN(), {}, {}, {}};
  const double weight = 1.0 / (scales.noise * kRampTolerance);
  const double rate = s.stiffness_N_per_m * scales.speed_m_per_s;
  const double second_onset_s = fit.reference_s(first + 1) + scales.half_period_s * own_second[0];
  const double elapsed_s = second_onset_s - s.onset_s;
  const double u = s.force_scale;
  // d(u I) / d ln u at fixed A: I depends on z0 = A / u
  const double scale_part = u * (s.after.intercept - s.slip.z0 * s.after.d_z0);
  RampResidual ramp;
  ramp.value = weight * (rate * elapsed_s + u * s.after.intercept - scales.force * own_second[1]);
  ramp.d_shared = {weight * (rate * elapsed_s + scale_part), -weight * scale_part, weight * u * s.after.d_zeta};
  ramp.d_first = {-weight * rate * scales.half_period_s, weight * scales.force * s.after.d_z0};
  ramp.d_second = {weight * rate * scales.half_period_s, -weight * scales.force};
  return ramp;
}

double huber_bound(std::size_t residuals) {
  return 3.0 * std::sqrt(static_cast<double>(residuals));
}

BlockFit::BlockFit(std::vector<CycleData> cycles, std::vector<double> reference_s, Scales scales, LevelModel level)
    : cycles_(std::move(cycles)), reference_s_(std::move(reference_s)), scales_(scales), level_(std::move(level)) {
  parameters.level.assign(level_.columns(), 0.0);
  parameters.cycles.assign(cycles_.size(), Own{});
  models_.reserve(cycles_.size());
  for (std::size_t i = 0; i < cycles_.size(); ++i) models_.emplace_back(cycles_[i], scales_, reference_s_[i], level_);
}

BlockFit duplicate(const BlockFit& fit) {
  std::vector<CycleData> cycles;
  std::vector<double> references_s;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    cycles.push_back(fit.data(i));
    references_s.push_back(fit.reference_s(i));
  }
  BlockFit same(std::move(cycles), std::move(references_s), fit.scales(), fit.level());
  same.parameters = fit.parameters;
  return same;
}

CycleState BlockFit::state(std::size_t cycle) const {
  CycleState state;
  models_[cycle].state(parameters.shared.data(), parameters.cycles[cycle].data(), state);
  return state;
}

double BlockFit::solve(const SolveOptions& options) {
  silence_solver_log();
  ceres::Problem::Options ownership;
  ownership.enable_fast_removal = false;
  ceres::Problem problem(ownership);
  double* shared = parameters.shared.data();
  const auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  std::size_t residuals = 0;
  for (const CycleModel& model : models_) residuals += model.residuals();
  ceres::Solver::Options solver = solver_options(options, residuals);
  for (std::size_t i = 0; i < models_.size(); ++i) {
    std::vector<double*> blocks{shared};
    if (level_.columns() > 0) blocks.push_back(parameters.level.data());
    blocks.push_back(parameters.cycles[i].data());
    ceres::LossFunction* loss = nullptr;
    if (options.robust) loss = new ceres::HuberLoss(huber_bound(models_[i].residuals()));
    problem.AddResidualBlock(new CycleCost(models_[i]), loss, blocks);
    ordering->AddElementToGroup(parameters.cycles[i].data(), 0);
  }
  // Inside a group Ceres orders blocks by their address: one block a group gives the same rounding in every run.
  ordering->AddElementToGroup(shared, 1);
  if (level_.columns() > 0) ordering->AddElementToGroup(parameters.level.data(), 2);
  for (std::size_t i = 0; options.continuous && i + 1 < models_.size(); ++i) {
    if (!cycles_[i].continuous_with_next) continue;
    problem.AddResidualBlock(new RampCost(*this, i), nullptr, shared, parameters.cycles[i].data(),
                             parameters.cycles[i + 1].data());
  }
  hold(problem, shared, options.held);
  if (!options.continuous) solver.linear_solver_ordering = ordering;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  if (!summary.IsSolutionUsable()) return std::numeric_limits<double>::infinity();
  return 2.0 * summary.final_cost;
}

double BlockFit::cycle_sum_of_squares(std::size_t cycle) const {
  const CycleModel& model = models_[cycle];
  std::vector<double> residuals(model.residuals());
  if (!model.evaluate(parameters.shared.data(), parameters.level.data(), parameters.cycles[cycle].data(),
                      residuals.data(), nullptr)) {
    return std::numeric_limits<double>::infinity();
  }
  double sum = 0.0;
  for (const double r : residuals) sum += r * r;
  return sum;
}

}  // namespace slipfit::fit
