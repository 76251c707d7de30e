#include "fit/selection/weakening_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/fit_thresholds.hpp"
#include "fit/cycle/start.hpp"
#include "fit/inference/smoothing.hpp"
#include "fit/problem/solve.hpp"
#include "fit/selection/clipping.hpp"
#include "fit/selection/finish.hpp"
#include "fit/selection/outliers.hpp"
#include "signal/robust.hpp"

namespace slipfit::fit {
namespace {

constexpr std::size_t kTrialCycles = 16;
constexpr std::size_t kSomeCycles = 64;  // enough to see that the slips are explained no better
constexpr double kHopeful = 1.1 * thresholds::kHalvedStack;
constexpr int kOwnIterations = 6;  // of onsets and forces by themselves
constexpr int kTrialIterations = 40;
constexpr int kFullIterations = 60;

/// k D_c / (F_s - F_k) to begin with: the sum of squares has several minima.
constexpr std::array kStarts{0.05, 0.2, 0.45, 0.75};

double median_slip_time_s(const BlockFit& blocks) {
  std::vector<double> times_s;
  times_s.reserve(blocks.size());
  for (std::size_t i = 0; i < blocks.size(); ++i) times_s.push_back(blocks.state(i).slip_s());
  return signal::median(std::move(times_s));
}

double damping_error(const DampedFit& fit) {
  return std::sqrt(std::max(0.0, fit.uncertainty.covariance(kDamping, kDamping)));
}

/// Every cycle has one: a search that ran to the longest slip distance may end beyond it.
bool has_slips(const BlockFit& fit) {
  for (std::size_t i = 0; i < fit.size(); ++i) {
    if (!std::isfinite(fit.cycle_sum_of_squares(i))) return false;
  }
  return true;
}

/// Steps gain little along the valley of D_c, zeta and w_n: what ends other fits leaves them an error off.
SolveOptions final_options(const Held& held) {
  SolveOptions options{held, false, true, kFullIterations};
  options.tolerance = 1e-7;
  return options;
}

class WeakeningFitter {
 public:
  /// `most_missed`: stacked residual that it has to promise to stay below before it is fitted to all cycles.
  WeakeningFitter(const FitInput& input, const DampedFit& coulomb, std::optional<double> most_missed)
      : input_(input),
        coulomb_(coulomb),
        most_missed_(most_missed),
        scales_(coulomb.blocks.scales()),
        held_(held_of(input.held)),
        excluded_(coulomb.excluded) {
    scales_.sensor_average_s = input.recording.conditions().sensor_average_s.value_or(0.0);
    // A slow onset begins before the slip of the Coulomb fit.
    half_width_s_ = 1.1 * median_slip_time_s(coulomb.blocks) + 0.5 * scales_.sensor_average_s;
    scales_.law = FrictionLaw::Weakening;
    scales_.slip_distance_m = scales_.force / std::exp(coulomb.blocks.parameters.globals[kLogStiffness]);
  }

  /// Empty where no start converges, where it is far from explaining the slips better or where the cycles do not tell
  /// the shared parameters apart.
  [[nodiscard]] std::optional<DampedFit> fit() {
    const std::vector<CycleData> cycles = same_cycles();
    if (cycles.size() < thresholds::kFewestFitted) return std::nullopt;
    const std::optional<Globals> start = best_start(some_of(cycles, kTrialCycles));
    if (!start) return std::nullopt;
    if (most_missed_ && !promises(cycles, *start)) return std::nullopt;
    std::optional<BlockFit> blocks = solved(cycles, *start);
    if (!blocks) return std::nullopt;
    exclude_outliers_of(*blocks);
    blocks = solved(same_cycles(), blocks->parameters.globals);
    if (!blocks) return std::nullopt;
    std::optional<DampedFit> fit =
        finish({*std::move(blocks), false, held_, std::nullopt, half_width_s_, excluded_, {}, {}});
    if (fit && is_negative(*fit)) fit = without_damping(*std::move(fit));
    if (fit && !input_.recording.conditions().sensor_average_s) {
      fit->rounding = estimate_smoothing(fit->blocks, fit->held, input_.recording.sample_interval_s());
    }
    return fit;
  }

 private:
  [[nodiscard]] std::optional<DampedFit> finish(DampedFit fit) const {
    std::optional<DampedFit> draft = with_uncertainty(std::move(fit), tolerated_misfit(input_.quality));
    return draft ? finish_fit(input_.recording, input_.quality, input_.segmentation, *std::move(draft)) : std::nullopt;
  }

  /// Outliers of the Coulomb fit may be what that law misses.
  void exclude_outliers_of(const BlockFit& blocks) {
    excluded_ = initial_exclusions(input_.recording, input_.quality);
    const Residuals residuals = without(residuals_of(input_.recording, blocks), excluded_);
    const std::vector<std::size_t> outliers = find_outliers(residuals, scales_.noise);
    const std::vector<std::size_t> censored = beyond_clip(input_.recording, input_.quality, residuals, scales_.noise);
    excluded_ = united(excluded_, united(outliers, censored));
  }

  [[nodiscard]] std::optional<BlockFit> solved(const std::vector<CycleData>& cycles, const Globals& start) const {
    BlockFit blocks = blocks_of(cycles);
    const bool is_solved = std::isfinite(solve_from(blocks, start, final_options(held_))) && has_slips(blocks);
    return is_solved ? std::optional(std::move(blocks)) : std::nullopt;
  }

  /// So many of the cycles, their slips with no more samples than their shape needs.
  [[nodiscard]] std::vector<CycleData> some_of(const std::vector<CycleData>& cycles, std::size_t count) const {
    std::vector<CycleData> some = spread_subset(cycles, count);
    for (CycleData& cycle : some) {
      const double middle_s = input_.segmentation.slips[cycle.slip].middle_s;
      cycle = thinned(std::move(cycle), middle_s, scales_.half_period_s, input_.recording.sample_interval_s());
    }
    return some;
  }

  [[nodiscard]] static std::size_t samples_of(const std::vector<CycleData>& cycles) {
    std::size_t samples = 0;
    for (const CycleData& cycle : cycles) samples += cycle.time_s.size();
    return samples;
  }

  /// The law may miss so much less of the mean shape of a slip that it is taken, as far as some of the cycles show,
  /// where these are much less work than all.
  [[nodiscard]] bool promises(const std::vector<CycleData>& cycles, const Globals& start) const {
    const std::vector<CycleData> some = some_of(cycles, kSomeCycles);
    if (2 * samples_of(some) >= samples_of(cycles)) return true;
    const std::optional<BlockFit> blocks = solved(some, start);
    if (!blocks) return false;
    const StackedResidual after = stacked_residual(*blocks, coulomb_.blocks);
    return after.size * after.size - after.by_chance * after.by_chance < *most_missed_ * *most_missed_;
  }

  /// The best zeta is below 0 clearly, or it is not told.
  static bool is_negative(const DampedFit& fit) {
    const double zeta = fit.blocks.parameters.globals[kDamping];
    const double error = damping_error(fit);
    const bool is_told = error < thresholds::kTellingDamping;
    return !fit.held[kDamping] && zeta < (is_told ? -thresholds::kNegativeSigmas * error : 0.0);
  }

  /// zeta is held at 0, and called unknown, as under Coulomb friction.
  [[nodiscard]] std::optional<DampedFit> without_damping(DampedFit fit) const {
    fit.refused_damping = fit.blocks.parameters.globals[kDamping];
    fit.held[kDamping] = true;
    fit.blocks.parameters.globals[kDamping] = 0.0;
    if (!std::isfinite(solve(fit.blocks, final_options(fit.held))) || !has_slips(fit.blocks)) return std::nullopt;
    return finish(std::move(fit));
  }

  /// Those of the Coulomb fit, cut wider.
  [[nodiscard]] std::vector<CycleData> same_cycles() const {
    const BlockFit& before = coulomb_.blocks;
    const HumLines hum{before.level().lines_Hz, scales_.time_begin_s};
    std::vector<CycleData> same;
    std::size_t next = 0;
    for (CycleData& cycle : cut_cycles(input_.recording, input_.segmentation, half_width_s_, excluded_, hum)) {
      while (next < before.size() && before.data(next).slip < cycle.slip) ++next;
      if (next == before.size() || before.data(next).slip != cycle.slip) continue;
      cycle.continuous_with_next = before.data(next).continuous_with_next;
      same.push_back(std::move(cycle));
    }
    return same;
  }

  [[nodiscard]] BlockFit blocks_of(const std::vector<CycleData>& cycles) const {
    std::vector<double> middles_s;
    middles_s.reserve(cycles.size());
    for (const CycleData& cycle : cycles) middles_s.push_back(input_.segmentation.slips[cycle.slip].middle_s);
    return {cycles, std::move(middles_s), scales_, coulomb_.blocks.level()};
  }

  /// First onsets and forces of the cycles by themselves, then all.
  double solve_from(BlockFit& blocks, const Globals& globals, SolveOptions options) const {
    set_start(blocks, input_.segmentation, globals);
    SolveOptions own = options;
    own.held.fill(true);
    own.max_iterations = kOwnIterations;
    if (!std::isfinite(solve(blocks, own))) return std::numeric_limits<double>::infinity();
    return solve(blocks, options);
  }

  [[nodiscard]] std::optional<Globals> best_start(const std::vector<CycleData>& cycles) const {
    SolveOptions options{held_, false, true, kTrialIterations};
    options.tolerance = 0.1;
    std::optional<Globals> best;
    double least = std::numeric_limits<double>::infinity();
    for (const double share : kStarts) {
      Globals globals = coulomb_.blocks.parameters.globals;
      // The slower onset makes a slip longer: so much slower is w_n of the Coulomb fit.
      if (!held_[kLogFrequency]) globals[kLogFrequency] += std::log1p(0.6 * share);
      if (!held_[kDamping]) globals[kDamping] = 0.05;
      globals[kFrictionSlope] = std::sqrt(share);
      BlockFit blocks = blocks_of(cycles);
      const double sum = solve_from(blocks, globals, options);
      if (!(sum < least)) continue;
      least = sum;
      best = blocks.parameters.globals;
    }
    return best;
  }

  const FitInput& input_;
  const DampedFit& coulomb_;
  std::optional<double> most_missed_;
  Scales scales_;
  Held held_;
  std::vector<std::size_t> excluded_;  // in ascending order
  double half_width_s_ = 0.0;
};

double slip_distance_m(const DampedFit& fit) {
  return fit.blocks.scales().slip_distance_m * std::pow(fit.blocks.parameters.globals[kFrictionSlope], 2);
}

/// D_c over its standard error.
double sigmas_of_distance(const DampedFit& fit) {
  const double root = fit.blocks.parameters.globals[kFrictionSlope];
  return 0.5 * std::abs(root) / std::sqrt(fit.uncertainty.covariance(kSlipDistance, kSlipDistance));
}

/// Why it cannot even be tried; empty: it can.
std::string hindrance(const FitInput& input, const DampedFit& coulomb) {
  if (coulomb.blocks.scales().sensor_lag_s > 0.0) return "it is not fitted with a sensor of first order";
  const double step_s = input.recording.sample_interval_s();
  const double samples = median_slip_time_s(coulomb.blocks) / step_s;
  return samples < thresholds::kShapeSamples ? too_few_samples(samples, step_s) : std::string();
}

/// Sets what the fit says for and against it. `before`: stacked residual of the Coulomb fit.
Candidate judged(Candidate candidate, const DampedFit& fit, const DampedFit& coulomb, double gain, double before) {
  const double sigmas = sigmas_of_distance(fit);
  const double after = stacked_residual(fit.blocks, coulomb.blocks).size;
  candidate.reason = fmt::format(
      "AICc {:.1f} {} than under Coulomb friction, D_c {:.1f} of its standard errors, mean residual over the phase of "
      "the slip {:.2g} % of the onset force in place of {:.2g} %",
      std::abs(gain), gain < 0.0 ? "higher" : "lower", sigmas, 100.0 * after, 100.0 * before);
  if (!(damping_error(fit) < thresholds::kTellingDamping)) {
    candidate.reason += fmt::format("; the standard error of the damping ratio is {:.2g}", damping_error(fit));
    return candidate;
  }
  // An average of the sensor takes as many parameters and explains the roundness, not the asymmetry of the slip.
  const double share = coulomb.average ? 1.0 : thresholds::kHalvedStack;
  candidate.chosen = gain > thresholds::kTierPrice && sigmas > thresholds::kSureTerm && after <= share * before;
  candidate.reason += candidate.chosen ? ": the slip distance is justified"
                                       : fmt::format(": it takes {:g} lower, {:g} standard errors and half",
                                                     thresholds::kTierPrice, thresholds::kSureTerm);
  return candidate;
}

}  // namespace

bool may_weaken(const DampedFit& coulomb) {
  return coulomb.misfit || coulomb.refused_damping || coulomb.average;
}

WeakeningTrial try_weakening(const FitInput& input, const DampedFit& coulomb, std::optional<Tier> forced) {
  WeakeningTrial trial{std::nullopt, {Tier::Weakening, 4, std::nullopt, std::nullopt, false, {}}, std::nullopt};
  trial.candidate.reason = hindrance(input, coulomb);
  if (!trial.candidate.reason.empty()) return trial;
  const double missed = stacked_residual(coulomb.blocks, coulomb.blocks).size;
  const bool must_promise = forced != Tier::Weakening && !coulomb.average;
  trial.fit = WeakeningFitter(input, coulomb, must_promise ? std::optional(kHopeful * missed) : std::nullopt).fit();
  if (!trial.fit) {
    trial.candidate.reason =
        "no slip distance between 0 and (F_s - F_k) / k halves what the slips of Coulomb friction miss";
    return trial;
  }
  const double effective = effective_samples(*trial.fit);
  trial.candidate = candidate_of(*trial.fit, Tier::Weakening, 4, effective);
  const Candidate other = candidate_of(coulomb, Tier::Damped, coulomb.average ? 4 : 3, effective);
  const double gain = *other.aicc - *trial.candidate.aicc;
  trial.candidate = judged(std::move(trial.candidate), *trial.fit, coulomb, gain, missed);
  if (coulomb.average && !trial.candidate.chosen && std::abs(gain) < thresholds::kTierPrice) {
    trial.warning = Warning{"samples_averaged",
                            fmt::format("friction that weakens over a slip distance of {:.2g} um explains the slips as "
                                        "well as the average of the sensor: the two cannot be told apart",
                                        1e6 * slip_distance_m(*trial.fit))};
  }
  return trial;
}

}  // namespace slipfit::fit
