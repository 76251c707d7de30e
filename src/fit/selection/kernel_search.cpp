#include "fit/selection/kernel_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "fit/cycle/start.hpp"
#include "fit/inference/smoothing.hpp"
#include "fit/problem/solve.hpp"
#include "signal/robust.hpp"

namespace slipfit::fit {
namespace {

constexpr double kMostChange = 4.0;  // of sigma^2 in one of Newton's steps
constexpr double kSmallStep = 0.05;  // in ln sigma^2
constexpr double kShrinking = 0.8;
constexpr double kWorthMoreSteps = 0.75;  // misfit over that of the plain fit
constexpr double kWorthAllCycles = 0.5;

/// Those of the cycles that the fit could use.
std::vector<CycleData> used_by(const BlockFit& fit, std::vector<CycleData> cycles) {
  std::vector<std::size_t> used;
  for (std::size_t i = 0; i < fit.size(); ++i) used.push_back(fit.data(i).slip);
  std::erase_if(cycles,
                [&](const CycleData& cycle) { return !std::binary_search(used.begin(), used.end(), cycle.slip); });
  return cycles;
}

double next_variance_s2(double variance_s2, const Smoothing& beyond) {
  return std::clamp(variance_s2 + beyond.variance_s2, variance_s2 / kMostChange, kMostChange * variance_s2);
}

}  // namespace

KernelSearch::KernelSearch(const Recording& recording, const Segmentation& segmentation, const HeldParameters& held,
                           const DampedFit& plain, double half_width_s, std::size_t count)
    : segmentation_(segmentation),
      held_(held_of(held)),
      step_s_(recording.sample_interval_s()),
      plain_(plain.blocks),
      plain_misfit_(plain.misfit) {
  const Scales& scales = plain_.scales();
  const HumLines hum{plain_.level().lines_Hz, scales.time_begin_s};
  std::vector<CycleData> cycles =
      spread_subset(used_by(plain_, cut_cycles(recording, segmentation, half_width_s, plain.excluded, hum)), count);
  std::vector<double> middles_s;
  for (CycleData& cycle : cycles) {
    middles_s.push_back(segmentation.slips[cycle.slip].middle_s);
    cycle = thinned(std::move(cycle), middles_s.back(), scales.half_period_s, step_s_);
  }
  cycles_ = std::make_shared<CycleSet>(std::move(cycles), std::move(middles_s), plain_.level(), scales);
}

std::optional<double> KernelSearch::converge(double average_s) const {
  constexpr int kMostSteps = 6;
  double last_step = std::numeric_limits<double>::infinity();
  double variance_s2 = average_s * average_s / 12.0;
  BlockFit fit = started(Kernel::MovingAverage, variance_s2);
  for (int step = 0; step < kMostSteps; ++step) {
    const std::optional<Held> held = solve_with_damping(fit);
    if (!held || (step == 0 && !misses_less(fit, kWorthMoreSteps))) return std::nullopt;
    const std::optional<Smoothing> beyond = estimate_smoothing(fit, *held, step_s_);
    if (!beyond) return std::nullopt;
    const double next_s2 = next_variance_s2(variance_s2, *beyond);
    const double change = std::abs(std::log(next_s2 / variance_s2));
    variance_s2 = next_s2;
    const double next_average_s = std::sqrt(12.0 * variance_s2);
    if (next_average_s < step_s_ || next_average_s > 2.0 * plain_.scales().half_period_s) return std::nullopt;
    if (change < kSmallStep || std::abs(beyond->variance_s2) < beyond->standard_error_s2)
      return misses_less(fit, kWorthAllCycles) ? std::optional(next_average_s) : std::nullopt;
    if (change > kShrinking * last_step) return std::nullopt;
    last_step = change;
    fit = with_kernel(fit, Kernel::MovingAverage, variance_s2);
  }
  return std::nullopt;
}

KernelSearch::Least KernelSearch::least_squares(Kernel kernel, double variance_s2) const {
  constexpr int kMostSteps = 3;
  Least least;
  BlockFit fit = started(kernel, variance_s2);
  for (int step = 0; step < kMostSteps; ++step) {
    const std::optional<Held> held = solve_with_damping(fit);
    if (!held) break;
    double sum = 0.0;
    for (std::size_t i = 0; i < fit.size(); ++i) sum += fit.cycle_sum_of_squares(i);
    if (!(sum < least.sum)) break;
    least = {sum, variance_s2, fit.parameters.globals, resting_share(fit)};
    const std::optional<Smoothing> beyond = estimate_smoothing(fit, *held, step_s_);
    if (!beyond) break;
    const double next_s2 = next_variance_s2(variance_s2, *beyond);
    if (std::abs(std::log(next_s2 / variance_s2)) < kSmallStep) break;
    variance_s2 = next_s2;
    fit = with_kernel(fit, kernel, variance_s2);
  }
  return least;
}

double KernelSearch::residuals() const {
  double count = 0.0;
  for (const CycleData& cycle : cycles_->cycles) count += static_cast<double>(cycle.residuals());
  return count;
}

/// Of the mean shape of the slips less than this share of what the plain fit misses.
bool KernelSearch::misses_less(const BlockFit& fit, double share) const {
  const std::optional<SegmentMisfit> misfit = find_misfit(fit, 0.0);
  return !misfit || !plain_misfit_ || std::abs(misfit->size) < share * std::abs(plain_misfit_->size);
}

BlockFit KernelSearch::with_kernel(const BlockFit& fit, Kernel kernel, double variance_s2) const {
  Scales scales = plain_.scales();
  scales.sensor_average_s = kernel == Kernel::MovingAverage ? std::sqrt(12.0 * variance_s2) : 0.0;
  scales.sensor_lag_s = kernel == Kernel::FirstOrder ? std::sqrt(variance_s2) : 0.0;
  BlockFit next(cycles_, scales);
  next.parameters = fit.parameters;
  return next;
}

/// Averaging draws the fall out: the squares of its own time and of W add up.
BlockFit KernelSearch::started(Kernel kernel, double variance_s2) const {
  constexpr double kLeast = 0.2;
  const double half_s = plain_.scales().half_period_s;
  const double own = std::max(kLeast, 1.0 - 12.0 * variance_s2 / (half_s * half_s));
  BlockFit fit(cycles_, plain_.scales());
  Globals globals{plain_.parameters.globals[kLogStiffness], std::log(std::numbers::pi / (half_s * std::sqrt(own))),
                  0.1};
  for (std::size_t i = 0; i < globals.size(); ++i) {
    if (held_[i]) globals[i] = plain_.parameters.globals[i];
  }
  set_start(fit, segmentation_, globals);
  fit.parameters.level = plain_.parameters.level;
  return with_kernel(fit, kernel, variance_s2);
}

/// What is held at the solution: zeta at 0 where its best value is negative. Empty: no solution.
std::optional<Held> KernelSearch::solve_with_damping(BlockFit& fit) const {
  constexpr int kIterations = 12;
  constexpr double kRough = 0.1;  // SolveOptions::tolerance
  Held held = held_;
  if (!std::isfinite(solve(fit, {held, false, true, kIterations, kRough}))) return std::nullopt;
  if (held[kDamping] || fit.parameters.globals[kDamping] >= 0.0) return held;
  fit.parameters.globals[kDamping] = 0.0;
  held[kDamping] = true;
  if (!std::isfinite(solve(fit, {held, false, true, kIterations, kRough}))) return std::nullopt;
  return held;
}

}  // namespace slipfit::fit
