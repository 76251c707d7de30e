#include "fit/problem/solve.hpp"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fit/problem/costs.hpp"
#include "fit/problem/cycle_cost.hpp"
#include "fit/problem/evaluations.hpp"
#include "fit/problem/solver_log.hpp"

namespace slipfit::fit {
namespace {

/// A Ceres problem of recordings. Inside a group Ceres orders blocks by their address: cycles stand in one array and
/// every other block is a group, so that the same input gives the same rounding.
class Bundle {
 public:
  Bundle(std::span<BlockFit> recordings, const SweepTerms& sweep, const SolveOptions& options)
      : recordings_(recordings),
        sweep_(sweep),
        options_(options),
        globals_(recordings.front().parameters.globals),
        ceres_(make_options()),
        ordering_(std::make_shared<ceres::ParameterBlockOrdering>()) {
    for (const BlockFit& recording : recordings_) {
      owns_.insert(owns_.end(), recording.parameters.cycles.begin(), recording.parameters.cycles.end());
    }
    double* local = owns_.empty() ? nullptr : owns_.front().data();
    for (BlockFit& recording : recordings_) local = add(recording, local);
    for (const SteadyRun& run : sweep_.steady) {
      if (!sweep_.sharing.level) break;
      ceres_.AddResidualBlock(new SteadyCost(run, sweep_.units, scales().law), nullptr, globals_.data(),
                              first().level.data());
    }
    ordering_->AddElementToGroup(globals_.data(), group_);
    hold();
  }

  double solve() {
    ceres::Solver::Summary summary;
    evaluations_.watch(ceres_);
    ceres::Solve(solver_options(), &ceres_, &summary);
    if (summary.termination_type == ceres::CONVERGENCE) evaluations_.restore_last_point();
    const Parameters& shared = first();
    std::size_t next = 0;
    for (BlockFit& recording : recordings_) {
      Parameters& parameters = recording.parameters;
      parameters.globals = globals_;
      if (sweep_.sharing.level && !parameters.level.empty()) parameters.level[0] = shared.level[0];
      if (sweep_.sharing.difference) parameters.difference = shared.difference;
      parameters.exponent = shared.exponent;
      for (Local& local : parameters.cycles) local = owns_[next++];
    }
    return summary.IsSolutionUsable() ? 2.0 * summary.final_cost : std::numeric_limits<double>::infinity();
  }

 private:
  ceres::Problem::Options make_options() {
    ceres::Problem::Options options;
    options.evaluation_callback = &evaluations_;
    options.enable_fast_removal = false;
    return options;
  }

  [[nodiscard]] Parameters& first() const { return recordings_.front().parameters; }
  [[nodiscard]] const Scales& scales() const { return recordings_.front().scales(); }

  /// Returns where the cycles of the next recording stand.
  double* add(BlockFit& recording, double* local) {
    Parameters& parameters = recording.parameters;
    const CycleModel& any = recording.model(0);
    std::vector<double*> blocks{globals_.data()};
    const auto add_block = [&](double* block) {
      blocks.push_back(block);
      if (!ordering_->IsMember(block)) ordering_->AddElementToGroup(block, group_++);
    };
    if (any.has_exponent()) add_block(&first().exponent);
    if (any.has_difference()) add_block(sweep_.sharing.difference ? &first().difference : &parameters.difference);
    if (any.has_constant()) add_block(sweep_.sharing.level ? first().level.data() : parameters.level.data());
    if (any.drift_parameters() > 0) add_block(parameters.level.data() + (any.has_constant() ? 1 : 0));
    for (std::size_t i = 0; i < recording.size(); ++i, local += std::tuple_size_v<Local>) {
      const CycleModel& model = recording.model(i);
      blocks.push_back(local);
      auto* loss = options_.robust ? new ceres::HuberLoss(huber_bound(model.residuals())) : nullptr;
      auto* cost = new CycleCost(model, room_);
      ceres_.AddResidualBlock(cost, loss, blocks);
      evaluations_.add(*cost, blocks);
      blocks.pop_back();
      ordering_->AddElementToGroup(local, 0);
      residuals_ += model.residuals();
    }
    if (options_.continuous) join_ramps(recording, local - recording.size() * std::tuple_size_v<Local>);
    return local;
  }

  void join_ramps(const BlockFit& recording, double* local) {
    for (std::size_t i = 0; i + 1 < recording.size(); ++i, local += std::tuple_size_v<Local>) {
      if (!recording.data(i).continuous_with_next) continue;
      ceres_.AddResidualBlock(new RampCost(recording, i), nullptr, globals_.data(), local,
                              local + std::tuple_size_v<Local>);
    }
  }

  void hold() {
    std::vector<int> constant;
    const std::size_t count = globals_of(scales().law);
    if (count > kFrictionRate && !options_.held[kFrictionRate]) {
      ceres_.SetParameterLowerBound(globals_.data(), static_cast<int>(kFrictionRate), kLeastRate);
      ceres_.SetParameterUpperBound(globals_.data(), static_cast<int>(kFrictionRate), kMostRate);
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (options_.held[i]) constant.push_back(static_cast<int>(i));
    }
    if (constant.size() == count) {
      ceres_.SetParameterBlockConstant(globals_.data());
    } else if (!constant.empty()) {
      ceres_.SetManifold(globals_.data(), new ceres::SubsetManifold(static_cast<int>(count), constant));
    }
  }

  /// What a fit can explain settles in some five steps from a solution of fewer cycles, however large it is. What it
  /// cannot may creep along a valley: not for longer than the rest of the program takes.
  [[nodiscard]] int most_iterations() const {
    constexpr double kMostEvaluations = 1.2e6;  // of a sample under Coulomb friction
    constexpr double kCycle = 24.0;             // evaluations that a cycle takes as long as beside those of its samples
    constexpr double kTerm = 2.0;               // by which weakening and an average each make an evaluation longer
    constexpr double kFewest = 6.0;
    double evaluations = static_cast<double>(residuals_) + kCycle * static_cast<double>(owns_.size());
    if (scales().law == FrictionLaw::Weakening) evaluations *= kTerm;
    if (scales().sensor_average_s > 0.0) evaluations *= kTerm;
    const double most = std::max(kFewest, kMostEvaluations / evaluations);
    return recordings_.size() > 1 ? options_.max_iterations
                                  : static_cast<int>(std::min<double>(options_.max_iterations, most));
  }

  [[nodiscard]] ceres::Solver::Options solver_options() const {
    ceres::Solver::Options solver;
    solver.max_num_iterations = most_iterations();
    // Continuity couples neighbouring cycles: a banded matrix with a border instead of independent blocks.
    solver.linear_solver_type = options_.continuous ? ceres::SPARSE_NORMAL_CHOLESKY : ceres::DENSE_SCHUR;
    // Damped steps move a long chain of joined cycles only a part of the way (23 steps at 5000 cycles, 4 undamped); it
    // starts at the solution for the cycles by themselves.
    if (options_.continuous) solver.initial_trust_region_radius = 1e10;
    if (!options_.continuous) solver.linear_solver_ordering = ordering_;
    solver.function_tolerance = options_.tolerance / static_cast<double>(residuals_);
    solver.gradient_tolerance = 1e-14;
    solver.parameter_tolerance = 1e-11;
    // A step into friction that runs away: shorten it.
    if (scales().law != FrictionLaw::Coulomb) solver.max_num_consecutive_invalid_steps = 20;
    solver.logging_type = ceres::SILENT;
    solver.num_threads = 1;
    return solver;
  }

  std::span<BlockFit> recordings_;
  const SweepTerms& sweep_;
  const SolveOptions& options_;
  Globals globals_;
  std::vector<Local> owns_;
  CycleRows room_;
  Evaluations evaluations_;
  ceres::Problem ceres_;
  std::shared_ptr<ceres::ParameterBlockOrdering> ordering_;
  int group_ = 1;
  std::size_t residuals_ = 0;
};

}  // namespace

double huber_bound(std::size_t residuals) {
  return 3.0 * std::sqrt(static_cast<double>(residuals));
}

double solve_together(std::span<BlockFit> recordings, const SweepTerms& sweep, const SolveOptions& options) {
  silence_solver_log();
  return Bundle(recordings, sweep, options).solve();
}

double solve(BlockFit& fit, const SolveOptions& options) {
  return solve_together({&fit, 1}, {}, options);
}

}  // namespace slipfit::fit
