#include "fit/selection/weakening_fitter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/fit_thresholds.hpp"
#include "core/thresholds.hpp"
#include "fit/cycle/start.hpp"
#include "fit/inference/smoothing.hpp"
#include "fit/problem/solve.hpp"
#include "fit/selection/carried_fit.hpp"
#include "fit/selection/clipping.hpp"
#include "fit/selection/finish.hpp"
#include "fit/selection/first_guess.hpp"
#include "fit/selection/fitted_average.hpp"
#include "fit/selection/outliers.hpp"
#include "fit/selection/reloading_fit.hpp"

namespace slipfit::fit {
namespace {

constexpr std::size_t kTrialCycles = 16;
constexpr std::size_t kFewCycles = 40;   // enough to see that the slips are explained no better
constexpr std::size_t kSomeCycles = 64;  // of many
constexpr double kHopeful = 1.1 * thresholds::kHalvedStack;
constexpr double kNothing = 0.1;   // of its error: a slip distance that is none
constexpr int kOwnIterations = 6;  // of onsets and forces by themselves
constexpr int kTrialIterations = 40;
constexpr int kFullIterations = 60;
constexpr int kStepIterations = 20;  // beside a solution for another average
/// SolveOptions::tolerance. Steps gain little along the valley of D_c, zeta and w_n: what ends other fits leaves them
/// an error off.
constexpr double kTolerance = 1e-7;
constexpr double kSomeTolerance = 1e-4;  // where a tenth of an error decides nothing

/// k D_c / (F_s - F_k) to begin with: the sum of squares has several minima.
constexpr std::array kStarts{0.05, 0.2, 0.45, 0.75};

SolveOptions final_options(const Held& held, double tolerance = kTolerance) {
  return {held, false, true, kFullIterations, tolerance};
}

class WeakeningFitter {
 public:
  WeakeningFitter(const FitInput& input, const DampedFit& coulomb, std::optional<double> missed,
                  std::optional<double> average_s = {}, const DampedFit* rival = nullptr)
      : input_(input),
        coulomb_(coulomb),
        missed_(missed),
        rival_(rival),
        scales_(coulomb.blocks.scales()),
        held_(held_of(input.held)),
        excluded_(coulomb.excluded) {
    scales_.sensor_average_s = average_s.value_or(input.recording.conditions().sensor_average_s.value_or(0.0));
    // A slow onset begins before the slip of the Coulomb fit.
    half_width_s_ = 1.1 * median_slip_s(coulomb.blocks) + 0.5 * scales_.sensor_average_s;
    scales_.law = FrictionLaw::Weakening;
    scales_.slip_distance_m = scales_.force / std::exp(coulomb.blocks.parameters.globals[kLogStiffness]);
  }

  [[nodiscard]] std::optional<DampedFit> fit() {
    const std::vector<CycleData> cycles = same_cycles();
    if (cycles.size() < thresholds::kFewestFitted) return std::nullopt;
    const std::optional<Globals> start = best_start(some_of(cycles, kTrialCycles));
    if (!start) return std::nullopt;
    if (rival_ != nullptr && !promises_more(cycles, *start)) return std::nullopt;
    if (missed_ && !promises(cycles, *start)) return std::nullopt;
    std::optional<BlockFit> blocks = solved(cycles, *start, kTolerance);
    if (!blocks || !(blocks = without_outliers(*std::move(blocks)))) return std::nullopt;
    std::optional<DampedFit> fit =
        finish({*std::move(blocks), false, held_, std::nullopt, half_width_s_, excluded_, {}, {}});
    if (fit && is_negative(*fit)) fit = without_damping(*std::move(fit));
    if (fit && rival_ != nullptr) return with_free_average(std::move(fit));
    if (fit && !input_.recording.conditions().sensor_average_s) {
      fit->rounding = estimate_smoothing(fit->blocks, fit->held, input_.recording.sample_interval_s());
    }
    return fit;
  }

 private:
  [[nodiscard]] std::optional<DampedFit> finish(DampedFit fit) const {
    std::optional<DampedFit> draft = with_uncertainty(std::move(fit), tolerated_misfit(input_.quality));
    draft = settle_rise(input_.recording.sample_interval_s(), input_.quality, std::move(draft));
    return draft ? finish_fit(input_.recording, input_.quality, input_.segmentation, *std::move(draft)) : std::nullopt;
  }

  /// The same cycles seen through an average of another variance, by Newton's step.
  [[nodiscard]] static std::optional<BlockFit> with_next_average(const BlockFit& blocks, const Smoothing& beyond,
                                                                 const Held& held) {
    const double average_s = blocks.scales().sensor_average_s;
    BlockFit next = averaged_by(blocks, beyond.next_variance_s2(average_s * average_s / 12.0));
    const bool is_solved = std::isfinite(solve(next, {held, false, true, kStepIterations})) && has_slips(next);
    return is_solved ? std::optional(std::move(next)) : std::nullopt;
  }

  [[nodiscard]] std::optional<DampedFit> with_free_average(std::optional<DampedFit> fit) const {
    constexpr int kMostSteps = 5;
    for (int step = 0; fit && step < kMostSteps; ++step) {
      const auto beyond = estimate_smoothing(fit->blocks, fit->held, input_.recording.sample_interval_s());
      if (!beyond) break;
      if (std::abs(beyond->variance_s2) < thresholds::kSettledAverage * beyond->standard_error_s2) {
        const double average_s = fit->blocks.scales().sensor_average_s;
        return with_average_error(*std::move(fit), average_s * average_s / 12.0, *beyond);
      }
      std::optional<BlockFit> blocks = with_next_average(fit->blocks, *beyond, fit->held);
      if (!blocks) break;
      fit->blocks = *std::move(blocks);
      fit = finish(*std::move(fit));
    }
    return std::nullopt;
  }

  /// Outliers of the Coulomb fit may be what that law misses.
  [[nodiscard]] std::optional<BlockFit> without_outliers(BlockFit blocks) {
    const std::vector<std::size_t> initial = initial_exclusions(input_.recording, input_.quality);
    const Residuals residuals = without(residuals_of(input_.recording, blocks), initial);
    const std::vector<std::size_t> outliers = find_outliers(residuals, scales_.noise);
    const std::vector<std::size_t> censored = beyond_clip(input_.recording, input_.quality, residuals, scales_.noise);
    std::vector<std::size_t> excluded = united(initial, united(outliers, censored));
    if (excluded == excluded_) return blocks;
    excluded_ = std::move(excluded);
    BlockFit clean = blocks_of(same_cycles());
    carry_over(blocks, clean);
    return settled(std::move(clean), held_);
  }

  [[nodiscard]] std::optional<BlockFit> solved(const std::vector<CycleData>& cycles, const Globals& start,
                                               double tolerance) const {
    BlockFit blocks = blocks_of(cycles);
    set_start(blocks, input_.segmentation, start);
    if (!solve_own(blocks, final_options(held_))) return std::nullopt;
    return settled(std::move(blocks), held_, tolerance);
  }

  /// From where it stands.
  [[nodiscard]] static std::optional<BlockFit> settled(BlockFit blocks, const Held& held,
                                                       double tolerance = kTolerance) {
    const bool is_solved = std::isfinite(solve(blocks, final_options(held, tolerance))) && has_slips(blocks);
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

  /// False where some of the cycles show that the law will not be taken. They are not asked where all of them are not
  /// much more work.
  [[nodiscard]] bool promises(const std::vector<CycleData>& cycles, const Globals& start) const {
    const std::vector<CycleData> some = some_of(cycles, std::clamp(cycles.size() / 3, kFewCycles, kSomeCycles));
    if (2 * samples_of(some) >= samples_of(cycles)) return true;
    const std::optional<BlockFit> blocks = solved(some, start, kSomeTolerance);
    if (!blocks || is_beaten(*blocks) || loses_sticks(*blocks)) return false;
    // In place of an average it need not explain more.
    return coulomb_.average || (explains_enough(*blocks) && tells_distance(*blocks));
  }

  /// Some of the cycles do not exclude that law and average together explain all of them better than the rival does.
  [[nodiscard]] bool promises_more(const std::vector<CycleData>& cycles, const Globals& start) const {
    constexpr int kFewSteps = 4;
    std::optional<BlockFit> blocks = solved(some_of(cycles, kTrialCycles), start, kSomeTolerance);
    if (!blocks) return false;
    BlockFit rival = carried_to(blocks->set(), rival_->blocks);
    if (!std::isfinite(solve(rival, {rival_->held, false, true}))) return true;
    const double least = sum_of_squares(rival) * (1.0 - 0.5 * thresholds::kTierPrice / effective_samples(*rival_));
    for (int step = 0; blocks && step < kFewSteps; ++step) {
      if (sum_of_squares(*blocks) < least) return true;
      const auto beyond = estimate_smoothing(*blocks, held_, input_.recording.sample_interval_s());
      if (!beyond) return false;
      blocks = with_next_average(*blocks, *beyond, held_);
    }
    return false;
  }

  /// Slips that come to rest under Coulomb friction would not.
  [[nodiscard]] bool loses_sticks(const BlockFit& some) const {
    return resting_share(some) < thresholds::kRestickShare &&
           resting_share(coulomb_.blocks) >= thresholds::kRestickShare;
  }

  /// The Coulomb fit explains these cycles better, beyond chance.
  [[nodiscard]] bool is_beaten(const BlockFit& some) const {
    BlockFit coulomb(some.set(), coulomb_.blocks.scales());
    carry_over(coulomb_.blocks, coulomb);
    const double independent = effective_samples(coulomb_) / coulomb_.uncertainty.samples;
    const double gain = std::log(sum_of_squares(coulomb) / sum_of_squares(some));
    return independent * static_cast<double>(residuals_in(some)) * gain < -thresholds::kTierPrice;
  }

  /// It may miss so much less of the mean shape of a slip that it is taken.
  [[nodiscard]] bool explains_enough(const BlockFit& some) const {
    const StackedResidual after = stacked_residual(some, coulomb_.blocks);
    return after.size * after.size - after.by_chance * after.by_chance < std::pow(kHopeful * *missed_, 2);
  }

  /// Waves and slips of Coulomb friction have a minimum at D_c = 0.
  [[nodiscard]] bool tells_distance(const BlockFit& some) const {
    DampedFit fit{some, false, held_, std::nullopt, half_width_s_, excluded_, {}, {}};
    fit.uncertainty = estimate_uncertainty(some, {held_, false});
    return sigmas_of_distance(fit) > kNothing;
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
    std::optional<BlockFit> blocks = settled(std::move(fit.blocks), fit.held);
    if (!blocks) return std::nullopt;
    fit.blocks = *std::move(blocks);
    return finish(std::move(fit));
  }

  /// Those of the Coulomb fit, cut wider.
  [[nodiscard]] std::vector<CycleData> same_cycles() const {
    const HumLines hum{coulomb_.blocks.level().lines_Hz, scales_.time_begin_s};
    return same_cycles_of(coulomb_.blocks,
                          cut_cycles(input_.recording, input_.segmentation, half_width_s_, excluded_, hum));
  }

  [[nodiscard]] BlockFit blocks_of(const std::vector<CycleData>& cycles) const {
    return {cycles, middles_s(input_.segmentation, cycles), scales_, coulomb_.blocks.level()};
  }

  /// Onsets and forces of the cycles by themselves; false where a slip has no solution.
  [[nodiscard]] static bool solve_own(BlockFit& blocks, SolveOptions options) {
    options.held.fill(true);
    options.max_iterations = kOwnIterations;
    return std::isfinite(solve(blocks, options));
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
      set_start(blocks, input_.segmentation, globals);
      const double sum = solve_own(blocks, options) ? solve(blocks, options) : least;
      if (!(sum < least)) continue;
      least = sum;
      best = blocks.parameters.globals;
    }
    return best;
  }

  const FitInput& input_;
  const DampedFit& coulomb_;
  std::optional<double> missed_;
  const DampedFit* rival_;  // the average is free then
  Scales scales_;
  Held held_;
  std::vector<std::size_t> excluded_;  // in ascending order
  double half_width_s_ = 0.0;
};

}  // namespace

std::optional<DampedFit> fit_weakening(const FitInput& input, const DampedFit& coulomb, std::optional<double> missed) {
  return WeakeningFitter(input, coulomb, missed).fit();
}

std::optional<DampedFit> fit_averaged_weakening(const FitInput& input, const DampedFit& coulomb, double average_s,
                                                const DampedFit& rival) {
  return WeakeningFitter(input, coulomb, std::nullopt, average_s, &rival).fit();
}

}  // namespace slipfit::fit
