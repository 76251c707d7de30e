#include "fit/selection/average_solver.hpp"

#include <algorithm>
#include <utility>

#include "core/fit_thresholds.hpp"
#include "core/thresholds.hpp"
#include "fit/cycle/start.hpp"
#include "fit/problem/solve.hpp"
#include "fit/selection/carried_fit.hpp"
#include "fit/selection/finish.hpp"
#include "fit/selection/reloading_fit.hpp"
#include "fit/selection/tiers.hpp"

namespace slipfit::fit {
namespace {

constexpr int kAveragedIterations = 30;  // a fit that explains the slips settles in fewer

/// Mean square that a fit leaves in those slips that `some` cycles of the recording hold.
double mean_square_in(const BlockFit& some, const BlockFit& fit) {
  double sum = 0.0;
  std::size_t residuals = 0;
  std::size_t next = 0;
  for (std::size_t i = 0; i < fit.size() && next < some.size(); ++i) {
    while (next < some.size() && some.data(next).slip < fit.data(i).slip) ++next;
    if (next == some.size() || some.data(next).slip != fit.data(i).slip) continue;
    sum += fit.cycle_sum_of_squares(i);
    residuals += fit.data(i).residuals();
  }
  return sum / static_cast<double>(residuals);
}

}  // namespace

Recording with_average(const Recording& recording, double average_s) {
  Conditions conditions = recording.conditions();
  conditions.sensor_average_s = average_s;
  const auto time_s = recording.time_s();
  const auto force = recording.force();
  return Recording::create({time_s.begin(), time_s.end()}, {force.begin(), force.end()}, conditions,
                           recording.provenance())
      .value();
}

bool follows_slips(const DampedFit& fit, double sample_interval_s) {
  const double negative = -thresholds::kNegativeSigmas * damping_error(fit);
  const bool is_shaped = !fit.misfit || fit.misfit->chance > thresholds::kMisfitChance;
  return is_shaped && !fit.refused_damping && fit.blocks.parameters.values(kDamping) > negative &&
         resting_share(fit.blocks) >= thresholds::kRestickShare && median_slip_s(fit.blocks) > sample_interval_s;
}

std::optional<DampedFit> AverageSolver::fit(double variance_s2, const Coordinates& near, const DampedFit* other) const {
  std::optional<DampedFit> fit = other != nullptr ? beside(*other, variance_s2, near) : drafted(variance_s2, near);
  if (!fit || !follows_slips(*fit, input_.recording.sample_interval_s())) return std::nullopt;
  return solved(with_free_time(fit->blocks, FreeTime::Average), *fit);
}

std::optional<DampedFit> AverageSolver::drafted(double variance_s2, const Coordinates& near) const {
  const double average_s = std::sqrt(12.0 * variance_s2);
  const Recording averaged = with_average(input_.recording, average_s);
  return settle_rise(
      input_, draft_damped({averaged, input_.quality, input_.segmentation, input_.held},
                           {near, plain_.excluded, plain_.blocks.level().reloading, plain_.blocks.level().per_cycle,
                            kAveragedIterations, [this](const BlockFit& some) { return is_hopeless(some); }, true}));
}

bool AverageSolver::is_hopeless(const BlockFit& some) const {
  const std::optional<SegmentMisfit> misfit = find_misfit(some, tolerated_misfit(input_.quality));
  if (misfit && !(misfit->chance > thresholds::kMisfitChance)) return true;
  return resting_share(some) < thresholds::kFewRest || mean_square_in(some, some) > mean_square_in(some, plain_.blocks);
}

std::optional<DampedFit> AverageSolver::beside(const DampedFit& other, double variance_s2,
                                               const Coordinates& start) const {
  BlockFit blocks = averaged_by(other.blocks, variance_s2);
  set_start(blocks, input_.segmentation, start);
  return solved(std::move(blocks), other);
}

std::optional<DampedFit> AverageSolver::solved(BlockFit blocks, const DampedFit& near) const {
  if (!std::isfinite(solve(blocks, {near.held, false, true}))) return std::nullopt;
  DampedFit fit{std::move(blocks), false, near.held, {}, near.half_width_s, near.excluded};
  return settle_rise(input_, with_uncertainty(std::move(fit), input_.quality));
}

}  // namespace slipfit::fit
