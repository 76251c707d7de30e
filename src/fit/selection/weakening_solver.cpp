#include "fit/selection/weakening_solver.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/fit_thresholds.hpp"
#include "fit/cycle/start.hpp"
#include "fit/level/add_hum.hpp"
#include "fit/problem/solve.hpp"
#include "fit/selection/carried_fit.hpp"
#include "fit/selection/clipping.hpp"
#include "fit/selection/first_guess.hpp"
#include "fit/selection/outliers.hpp"
#include "fit/selection/recut.hpp"
#include "fit/selection/reloading_fit.hpp"

namespace slipfit::fit {
namespace {

constexpr std::size_t kFewCycles = 40;   // enough to see that the slips are explained no better
constexpr std::size_t kSomeCycles = 64;  // of many
constexpr int kOwnIterations = 6;        // of onsets and forces by themselves
constexpr int kFullIterations = 60;
constexpr int kRoughSteps = 20;   // to WeakeningSolver::kRoughTolerance: further ones gain a tenth of an error each
constexpr double kNothing = 0.1;  // of its error: a slip distance that is none
constexpr double kDraftTolerance = 0.1;  // SolveOptions::tolerance of a draft
/// SolveOptions::tolerance. Steps gain little along the valley of D_c, zeta and w_n: what ends other fits leaves them
/// an error off.
constexpr double kTolerance = 1e-7;

/// Of the rise after slips, in that of the Coulomb fit: behind an average it looks longer.
constexpr std::array kRiseLengths{1.0, 0.5};
constexpr int kRiseSteps = 2;  // of a draft, each after the slips of the one before

std::size_t samples_of(const std::vector<CycleData>& cycles) {
  std::size_t samples = 0;
  for (const CycleData& cycle : cycles) samples += cycle.time_s.size();
  return samples;
}

/// From where it stands.
std::optional<BlockFit> settled(BlockFit blocks, const Held& held, double tolerance) {
  const int most = tolerance < WeakeningSolver::kRoughTolerance ? kFullIterations : kRoughSteps;
  const bool is_solved = std::isfinite(solve(blocks, {held, false, true, most, tolerance})) && has_slips(blocks);
  return is_solved ? std::optional(std::move(blocks)) : std::nullopt;
}

/// Onsets and forces of the cycles by themselves; false where a slip has no solution.
bool solve_own(BlockFit& blocks, SolveOptions options) {
  options.held.fill(true);
  options.max_iterations = kOwnIterations;
  options.tolerance = kDraftTolerance;
  return std::isfinite(solve(blocks, options));
}

/// The best zeta is below 0 clearly, or it is not told.
bool is_negative(const DampedFit& fit) {
  const double zeta = fit.blocks.parameters.values(kDamping);
  const double error = damping_error(fit);
  const bool is_told = error < thresholds::kTellingDamping;
  return !fit.held[kDamping] && zeta < (is_told ? -thresholds::kNegativeSigmas * error : 0.0);
}

}  // namespace

WeakeningSolver::WeakeningSolver(const FitInput& input, const DampedFit& coulomb, double half_width_s)
    : input_(input),
      coulomb_(coulomb),
      scales_(coulomb.blocks.scales()),
      held_(held_of(input.held)),
      half_width_s_(half_width_s),
      hum_(hum_of(input.recording, coulomb.blocks)) {
  scales_.law = FrictionLaw::Weakening;
  scales_.slip_distance_m = scales_.force / std::exp(coulomb.blocks.parameters.values(kLogStiffness));
}

std::vector<CycleData> WeakeningSolver::cycles() const {
  return cycles_without(coulomb_.excluded);
}

std::vector<CycleData> WeakeningSolver::some_of(const std::vector<CycleData>& cycles, std::size_t count) const {
  std::vector<CycleData> some = spread_subset(cycles, count);
  for (CycleData& cycle : some) {
    const double middle_s = input_.segmentation.slips[cycle.slip].middle_s;
    cycle = thinned(std::move(cycle), middle_s, scales_.half_period_s, input_.recording.sample_interval_s());
  }
  return some;
}

std::vector<CycleData> WeakeningSolver::enough_of(const std::vector<CycleData>& cycles) const {
  std::vector<CycleData> some = some_of(cycles, std::clamp(cycles.size() / 3, kFewCycles, kSomeCycles));
  if (2 * samples_of(some) >= samples_of(cycles)) some.clear();
  return some;
}

std::optional<WeakeningSolver::Draft> WeakeningSolver::draft(const std::vector<CycleData>& cycles, double average_s,
                                                             const Start& start) const {
  SolveOptions options{held_, false, true, start.most_iterations};
  options.tolerance = kDraftTolerance;
  const std::span<const double> lengths(kRiseLengths.data(),
                                        coulomb_.blocks.level().reloading ? kRiseLengths.size() : 1);
  std::optional<Draft> best;
  for (const double weakening : start.weakenings) {
    Coordinates near = coulomb_.blocks.parameters.values;
    // The slower onset makes a slip longer: so much slower is w_n of the Coulomb fit.
    if (!held_[kLogFrequency]) near(kLogFrequency) = start.log_omega + std::log1p(0.6 * weakening);
    if (!held_[kDamping]) near(kDamping) = 0.05;
    near(kSlipDistance) = std::sqrt(weakening);
    for (const double times : lengths) {
      const std::optional<BlockFit> first = started(cycles, {average_s, FreeTime::None}, near, coulomb_.blocks.level());
      if (!first) return best;
      BlockFit blocks = *first;
      blocks.parameters.values(kReloadLength) += std::log(times);
      if (!solve_own(blocks, options)) continue;
      double sum = solve(blocks, options);
      for (int i = 0; i < kRiseSteps && blocks.level().reloading && std::isfinite(sum); ++i) {
        blocks = with_rise_after(blocks);
        sum = solve(blocks, options);
      }
      if (std::isfinite(sum) && rises(blocks) && (!best || sum < best->sum_of_squares))
        best = Draft{std::move(blocks), sum};
    }
  }
  return best;
}

std::optional<BlockFit> WeakeningSolver::solved(const std::vector<CycleData>& cycles, const BlockFit& near,
                                                double tolerance) const {
  std::optional<BlockFit> blocks = started(cycles, averaging_of(near), near.parameters.values, near.level());
  if (!blocks || !solve_own(*blocks, {held_, false, true})) return std::nullopt;
  return settled(*std::move(blocks), held_, tolerance);
}

std::optional<DampedFit> WeakeningSolver::fit(const std::vector<CycleData>& cycles, const BlockFit& near) const {
  std::optional<BlockFit> blocks = solved(cycles, near, kTolerance);
  if (!blocks) return std::nullopt;
  std::optional<DampedFit> fit = without_outliers(*std::move(blocks));
  if (fit) fit = finish_settled(input_, *std::move(fit));
  return fit && is_negative(*fit) ? without_damping(*std::move(fit)) : std::move(fit);
}

bool WeakeningSolver::tells_distance(const BlockFit& blocks) const {
  DampedFit fit{blocks, false, held_};
  fit.uncertainty = estimate_uncertainty(blocks, {held_, false});
  return sigmas_of_distance(fit) > kNothing;
}

std::vector<CycleData> WeakeningSolver::cycles_without(const std::vector<std::size_t>& excluded) const {
  return same_cycles_of(coulomb_.blocks,
                        cut_cycles(input_.recording, input_.segmentation, half_width_s_, excluded, hum_));
}

std::optional<BlockFit> WeakeningSolver::blocks_of(const std::vector<CycleData>& cycles, Averaging average,
                                                   const LevelModel& level) const {
  Scales scales = scales_;
  scales.sensor_average_s = average.seconds;
  scales.free_time = average.free;
  return BlockFit::create(cycles, middles_s(input_.segmentation, cycles), scales, level);
}

std::optional<BlockFit> WeakeningSolver::started(const std::vector<CycleData>& cycles, Averaging average,
                                                 const Coordinates& start, const LevelModel& level) const {
  std::optional<BlockFit> blocks = blocks_of(cycles, average, level);
  if (!blocks) return blocks;
  set_start(*blocks, input_.segmentation, start);
  return with_rise_after(*blocks);
}

DampedFit WeakeningSolver::unfinished(BlockFit blocks, std::vector<std::size_t> excluded) const {
  return {std::move(blocks), false, held_, std::nullopt, half_width_s_, std::move(excluded)};
}

/// Outliers of the Coulomb fit may be what that law misses. Empty where they leave too few cycles.
std::optional<DampedFit> WeakeningSolver::without_outliers(BlockFit blocks) const {
  const std::vector<std::size_t> initial = initial_exclusions(input_.recording, input_.quality);
  const Residuals residuals = without(residuals_of(input_.recording, blocks), initial);
  const std::vector<std::size_t> outliers = find_outliers(residuals, scales_.noise);
  const std::vector<std::size_t> censored = beyond_clip(input_.recording, input_.quality, residuals, scales_.noise);
  std::vector<std::size_t> excluded = united(initial, united(outliers, censored));
  if (excluded == coulomb_.excluded) return unfinished(std::move(blocks), std::move(excluded));
  std::optional<BlockFit> clean = blocks_of(cycles_without(excluded), averaging_of(blocks), blocks.level());
  if (!clean) return std::nullopt;
  carry_over(blocks, *clean);
  std::optional<BlockFit> again = settled(with_rise_after(*clean), held_, kTolerance);
  return again ? std::optional(unfinished(*std::move(again), std::move(excluded))) : std::nullopt;
}

/// zeta is held at 0, and called unknown, as under Coulomb friction.
std::optional<DampedFit> WeakeningSolver::without_damping(DampedFit fit) const {
  fit.refused_damping = fit.blocks.parameters.values(kDamping);
  fit.held[kDamping] = true;
  fit.blocks.parameters.values(kDamping) = 0.0;
  std::optional<BlockFit> blocks = settled(std::move(fit.blocks), fit.held, kTolerance);
  if (!blocks) return std::nullopt;
  fit.blocks = *std::move(blocks);
  return finish_settled(input_, std::move(fit));
}

}  // namespace slipfit::fit
