#include "fit/selection/joint_solution.hpp"

#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <limits>
#include <utility>

#include "fit/problem/held_values.hpp"
#include "signal/robust.hpp"

namespace slipfit::fit {
namespace {

constexpr double kRoughJointTolerance = 0.1;
constexpr double kJointTolerance = 1e-4;
constexpr int kQuickJointIterations = 10;
constexpr int kMostJointIterations = 50;
/// What the recordings share is believed unless chance would hardly give such a disagreement.
constexpr double kShareChance = 1e-3;
/// Dependence on the speed is believed beyond this chance.
constexpr double kLawChance = 0.01;

std::unique_ptr<JointProblem> problem_of(const SweepData& data, Shares shares, const std::vector<std::size_t>& used) {
  std::vector<const BlockFit*> blocks;
  std::vector<JointRun> runs;
  for (const std::size_t i : used) {
    blocks.push_back(&data.single[i]->blocks);
    runs.push_back(joint_run(*data.single[i], data.loads[i]));
  }
  return std::make_unique<JointProblem>(std::move(blocks), std::move(runs), data.steady, data.scales, shares);
}

/// Residual rows over parameters: each stick bin counts as its two rows, as it does in chi2.
double residual_freedom(const JointProblem& problem, const JointHeld& held) {
  double freedom = problem.rows() - static_cast<double>(problem.columns());
  for (const bool is_held : held) freedom += is_held ? 1.0 : 0.0;
  for (std::size_t r = 0; r < problem.size(); ++r) {
    const BlockFit& recording = problem.recording(r);
    freedom -= static_cast<double>(recording.size() * recording.model(0).own_parameters());
  }
  return std::max(1.0, freedom);
}

std::optional<JointSolution> at_minimum(std::unique_ptr<JointProblem> problem, const JointHeld& held) {
  const double chi2 = problem->solve(held, kMostJointIterations, kJointTolerance);
  if (!std::isfinite(chi2)) return std::nullopt;
  const double freedom = residual_freedom(*problem, held);
  return JointSolution{std::move(problem), held, chi2, freedom};
}

class SweepFitter {
 public:
  SweepFitter(const SweepData& data, const FitOptions& options) : data_(data), fixed_(fixed_values(options)) {}

  [[nodiscard]] std::optional<SweepFits> fit() const {
    std::optional<JointSolution> free = fit_velocity({false, false});
    if (!free) return std::nullopt;
    JointSolution velocity = with_shares(std::move(*free));
    std::optional<JointSolution> coulomb = coulomb_like(velocity);
    SweepFits fits{std::move(velocity), std::move(coulomb)};
    const double extra = 2.0;  // slope and rate
    fits.p_value = fits.coulomb ? chance(fits.coulomb->chi2 - fits.velocity.chi2, extra, fits.velocity) : 0.0;
    fits.depends_on_speed = fits.p_value < kLawChance;
    return fits;
  }

 private:
  /// Chance of such a gain in chi2 by `extra` parameters (or constraints taken off).
  static double chance(double gain, double extra, const JointSolution& rich) {
    const double ratio = gain / extra / (rich.chi2 / rich.degrees_of_freedom);
    if (!(ratio > 0.0)) return 1.0;
    const boost::math::fisher_f_distribution<double> by_chance(extra, rich.degrees_of_freedom);
    return boost::math::cdf(boost::math::complement(by_chance, ratio));
  }

  [[nodiscard]] JointHeld held_parameters(SweepLaw law) const {
    JointHeld held{};
    held[kJointStiffness] = fixed_.stiffness_N_per_m.has_value();
    held[kJointFrequency] = fixed_.omega_rad_per_s.has_value();
    held[kJointDamping] = fixed_.damping_ratio.has_value();
    if (law == SweepLaw::Coulomb) held[kFrictionSlope] = held[kFrictionRate] = true;
    return held;
  }

  /// Medians over the recordings, each recording's own cycles.
  void set_start(JointProblem& problem, const std::vector<std::size_t>& used) const {
    std::array<std::vector<double>, 3> values;
    for (const std::size_t i : used) {
      for (std::size_t p = 0; p < 3; ++p) values[p].push_back(data_.single[i]->blocks.parameters.shared[p]);
    }
    JointShared& shared = problem.parameters.shared;
    shared = {signal::median(values[0]), signal::median(values[1]), std::clamp(signal::median(values[2]), 0.0, 0.3),
              0.0, 0.0};
    if (fixed_.stiffness_N_per_m) shared[kJointStiffness] = std::log(*fixed_.stiffness_N_per_m);
    if (fixed_.omega_rad_per_s) shared[kJointFrequency] = std::log(*fixed_.omega_rad_per_s);
    if (fixed_.damping_ratio) shared[kJointDamping] = *fixed_.damping_ratio;
    std::vector<double> levels;
    std::vector<double> differences;
    for (std::size_t r = 0; r < used.size(); ++r) {
      const DampedFit& single = *data_.single[used[r]];
      const double unit = data_.loads[used[r]] * data_.scales.force;
      levels.push_back(level_of(single) / unit);
      differences.push_back(mean_onset_force(single) / unit);
      const auto& level = single.blocks.parameters.level;
      const std::size_t skip = single.blocks.level().terms > 0 ? 1 : 0;
      std::copy(level.begin() + static_cast<std::ptrdiff_t>(skip), level.end(), problem.parameters.drifts[r].begin());
    }
    if (problem.shares().level) levels = {signal::median(levels)};
    if (problem.shares().difference) differences = {signal::median(differences)};
    problem.parameters.levels = levels;
    problem.parameters.differences = differences;
  }

  /// Several rates: a wrong sign of alpha is a minimum of its own.
  [[nodiscard]] std::optional<JointSolution> fit_velocity(Shares shares) const {
    std::unique_ptr<JointProblem> problem = problem_of(data_, shares, data_.fitted);
    JointHeld held = held_parameters(SweepLaw::Velocity);
    JointProblem::Parameters best;
    double best_chi2 = std::numeric_limits<double>::infinity();
    for (const double rate : {-1.0, 1.0, -4.0}) {
      set_start(*problem, data_.fitted);
      problem->parameters.shared[kFrictionRate] = rate;
      JointHeld quick = held;
      quick[kFrictionRate] = true;
      const double chi2 = problem->solve(quick, kQuickJointIterations, kRoughJointTolerance);
      if (chi2 >= best_chi2) continue;
      best_chi2 = chi2;
      best = problem->parameters;
    }
    if (!std::isfinite(best_chi2)) return std::nullopt;
    problem->parameters = best;
    return at_minimum(std::move(problem), held);
  }

  /// Shares as much as the data agree with: both, then one of the two, else nothing.
  [[nodiscard]] JointSolution with_shares(JointSolution free) const {
    const std::size_t runs = data_.fitted.size();
    for (const Shares shares : {Shares{true, true}, Shares{false, true}, Shares{true, false}}) {
      std::optional<JointSolution> shared = fit_velocity(shares);
      if (!shared) continue;
      // With more freedom no fit can be worse: where it is, it had ended in another minimum.
      if (shared->chi2 < free.chi2) {
        std::optional<JointSolution> better = released(*shared);
        if (better && better->chi2 < free.chi2) free = std::move(*better);
      }
      const double steady = shares.level ? static_cast<double>(data_.steady.size()) : 0.0;
      const double shared_kinds = (shares.level ? 1.0 : 0.0) + (shares.difference ? 1.0 : 0.0);
      const double constraints = static_cast<double>(runs - 1) * shared_kinds + steady;
      if (chance(shared->chi2 - free.chi2, constraints, free) > kShareChance) return std::move(*shared);
    }
    return free;
  }

  /// From a shared solution on with nothing shared.
  [[nodiscard]] std::optional<JointSolution> released(const JointSolution& shared) const {
    std::unique_ptr<JointProblem> problem = problem_of(data_, {false, false}, data_.fitted);
    const JointProblem::Parameters& from = shared.problem->parameters;
    problem->parameters = from;
    if (from.levels.size() == 1) problem->parameters.levels.assign(problem->size(), from.levels[0]);
    if (from.differences.size() == 1) problem->parameters.differences.assign(problem->size(), from.differences[0]);
    return at_minimum(std::move(problem), shared.held);
  }

  [[nodiscard]] std::optional<JointSolution> coulomb_like(const JointSolution& velocity) const {
    std::unique_ptr<JointProblem> problem = problem_of(data_, velocity.problem->shares(), data_.fitted);
    set_start(*problem, data_.fitted);
    return at_minimum(std::move(problem), held_parameters(SweepLaw::Coulomb));
  }

  const SweepData& data_;
  HeldValues fixed_;
};

}  // namespace

std::optional<SweepFits> fit_sweep(const SweepData& data, const FitOptions& options) {
  return SweepFitter(data, options).fit();
}

std::optional<JointSolution> with_rate(const SweepData& data, const JointSolution& solution, double rate) {
  std::unique_ptr<JointProblem> problem = problem_of(data, solution.problem->shares(), data.fitted);
  problem->parameters = solution.problem->parameters;
  problem->parameters.shared[kFrictionRate] = rate;
  JointHeld held = solution.held;
  held[kFrictionRate] = true;
  return at_minimum(std::move(problem), held);
}

std::optional<JointSolution> leave_out(const SweepData& data, const JointSolution& solution, std::size_t recording) {
  std::vector<std::size_t> used;
  for (const std::size_t i : data.fitted) {
    if (i != recording) used.push_back(i);
  }
  if (used.size() < 2) return std::nullopt;
  std::unique_ptr<JointProblem> problem = problem_of(data, solution.problem->shares(), used);
  const JointProblem::Parameters& from = solution.problem->parameters;
  JointProblem::Parameters& to = problem->parameters;
  to.shared = from.shared;
  to.levels.clear();
  to.differences.clear();
  to.drifts.clear();
  to.cycles.clear();
  for (std::size_t r = 0; r < data.fitted.size(); ++r) {
    if (data.fitted[r] == recording) continue;
    if (from.levels.size() > 1 || to.levels.empty()) to.levels.push_back(from.levels[from.levels.size() > 1 ? r : 0]);
    if (from.differences.size() > 1 || to.differences.empty()) {
      to.differences.push_back(from.differences[from.differences.size() > 1 ? r : 0]);
    }
    to.drifts.push_back(from.drifts[r]);
    to.cycles.push_back(from.cycles[r]);
  }
  return at_minimum(std::move(problem), solution.held);
}

}  // namespace slipfit::fit
