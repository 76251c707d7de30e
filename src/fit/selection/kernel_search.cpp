#include "fit/selection/kernel_search.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "fit/cycle/start.hpp"
#include "fit/problem/solve.hpp"
#include "fit/selection/carried_fit.hpp"
#include "fit/selection/first_guess.hpp"
#include "fit/selection/recut.hpp"
#include "fit/selection/reloading_fit.hpp"
#include "signal/robust.hpp"

namespace slipfit::fit {
namespace {

constexpr double kSlipVariance = 0.25 - 2.0 / (std::numbers::pi * std::numbers::pi);  // of half a sine that lasts 1
constexpr double kLargestShare = 1.4;  // of the seen variance: damping and the drive make a slip last longer
constexpr double kBeyondSlip = 2.0;    // where the sum still falls at the largest
constexpr double kShareStep = 0.1;
constexpr int kMinimumBits = 6;

/// Whether zeta = 0, at which this fit has been solved, is better than any above it: where all else is at its best, a
/// small step tells.
bool is_best_undamped(BlockFit fit) {
  constexpr double kStep = 1e-3;
  const double sum = sum_of_squares(fit);
  fit.parameters.values(kDamping) = kStep;
  return !(sum_of_squares(fit) < sum);
}

}  // namespace

KernelSearch::KernelSearch(const FitInput& input, const BlockFit& plain, CycleSet cycles)
    : segmentation_(input.segmentation),
      held_(held_of(input.held)),
      plain_(plain),
      cycles_(std::make_shared<const CycleSet>(std::move(cycles))) {}

std::optional<KernelSearch> KernelSearch::create(const FitInput& input, const DampedFit& plain, double half_width_s,
                                                 std::size_t count) {
  const auto& [recording, quality, segmentation, held] = input;
  const Scales& scales = plain.blocks.scales();
  const LevelModel& level = plain.blocks.level();
  const HumLines hum{level.lines_Hz, scales.time_begin_s};
  std::vector<CycleData> cycles = spread_subset(
      same_cycles_of(plain.blocks, cut_cycles(recording, segmentation, half_width_s, plain.excluded, hum)), count);
  std::vector<double> middles = middles_s(segmentation, cycles);
  for (std::size_t i = 0; i < cycles.size(); ++i) {
    cycles[i] = thinned(std::move(cycles[i]), middles[i], scales.half_period_s, recording.sample_interval_s());
  }
  std::optional<CycleSet> set = CycleSet::create(std::move(cycles), std::move(middles), level, scales);
  if (!set) return std::nullopt;
  return KernelSearch(input, plain.blocks, *std::move(set));
}

std::vector<KernelSearch::Least> KernelSearch::minima(double least_gain) const {
  // The variances of the average and of the slip's own velocity add up to what is seen.
  const double seen_s2 = seen_variance_s2();
  std::vector<double> shares{0.0, 0.125 * kShareStep, 0.25 * kShareStep, 0.5 * kShareStep};
  for (double share = kShareStep; share < kLargestShare; share += kShareStep) shares.push_back(share);
  std::vector<Least> scan;
  scan.reserve(shares.size());
  Least start;
  start.parameters = started().parameters;
  const auto scan_next = [&](double share) {
    const std::size_t known = scan.size();
    return at(share * seen_s2, known > 0 ? scan.back() : start, known > 1 ? &scan[known - 2] : nullptr);
  };
  for (const double share : shares) scan.push_back(scan_next(share));
  const auto is_falling = [&] { return scan.back().sum < scan[scan.size() - 2].sum; };
  while (is_falling() && shares.back() < kBeyondSlip) {
    shares.push_back(shares.back() + kShareStep);
    scan.push_back(scan_next(shares.back()));
  }
  std::vector<Least> minima;
  for (std::size_t i = 1; i + 1 < scan.size(); ++i) {
    if (!(scan[i].sum < scan[i - 1].sum && scan[i].sum <= scan[i + 1].sum)) continue;
    std::uintmax_t most = 8;
    const auto between = [&](double share) {
      return at(share * seen_s2, scan[i], &scan[share < shares[i] ? i - 1 : i + 1]);
    };
    const auto least = boost::math::tools::brent_find_minima([&](double share) { return between(share).sum; },
                                                             shares[i - 1], shares[i + 1], kMinimumBits, most);
    minima.push_back(between(least.first));
  }
  for (Least& least : minima) least.gain = 1.0 - least.sum / scan.front().sum;
  std::erase_if(minima, [&](const Least& least) { return !(least.gain > least_gain); });
  std::sort(minima.begin(), minima.end(), [](const Least& a, const Least& b) { return a.sum < b.sum; });
  return minima;
}

double KernelSearch::seen_variance_s2() const {
  const double slip_s = std::numbers::pi / std::exp(plain_.parameters.values(kLogFrequency));
  return kSlipVariance * slip_s * slip_s;
}

/// On the line through two solutions.
Parameters KernelSearch::extrapolated(double variance_s2, const Least& near, const Least& other) const {
  const double steps = (variance_s2 - near.variance_s2) / (near.variance_s2 - other.variance_s2);
  const auto follow = [&](double& value, double from) { value += steps * (value - from); };
  Parameters p = near.parameters;
  const double bend_before = log_frequency_gain(near.variance_s2) - log_frequency_gain(other.variance_s2);
  for (Eigen::Index i = 0; i < kOfSlip; ++i) {
    if (!held_[static_cast<std::size_t>(i)])
      follow(p.values(i), other.parameters.values(i) + (i == kLogFrequency ? bend_before : 0.0));
  }
  p.values(kDamping) = std::max(0.0, p.values(kDamping));
  for (std::size_t i = 0; i < p.level.size(); ++i) follow(p.level[i], other.parameters.level[i]);
  for (std::size_t i = 0; i < p.cycles.size(); ++i) {
    for (std::size_t j = 0; j < p.cycles[i].size(); ++j) follow(p.cycles[i][j], other.parameters.cycles[i][j]);
  }
  return p;
}

KernelSearch::Least KernelSearch::at(double variance_s2, const Least& near, const Least* other) const {
  Least least;
  least.variance_s2 = variance_s2;
  BlockFit fit(cycles_, plain_.scales());
  fit.parameters = near.parameters;
  fit = with_kernel(fit, FreeTime::Average, variance_s2);
  const double gain =
      held_[kLogFrequency] ? 0.0 : log_frequency_gain(variance_s2) - log_frequency_gain(near.variance_s2);
  fit.parameters.values(kLogFrequency) += gain;
  if (other != nullptr && std::isfinite(other->sum)) {
    BlockFit start = fit;
    start.parameters = extrapolated(variance_s2, near, *other);
    start.parameters.values(kLogFrequency) += gain;
    if (std::isfinite(sum_of_squares(start))) fit = std::move(start);
  }
  least.parameters = fit.parameters;
  if (!solve_with_damping(fit)) return least;
  least.sum = sum_of_squares(fit);
  least.parameters = fit.parameters;
  least.resting = resting_share(fit);
  return least;
}

KernelSearch::Least KernelSearch::least_lag(const Least& near, double variance_s2) const {
  BlockFit fit(cycles_, plain_.scales());
  fit.parameters = near.parameters;
  return solved(with_kernel(fit, FreeTime::Lag, variance_s2), FreeTime::Lag);
}

KernelSearch::Least KernelSearch::refined(const Least& near) const {
  BlockFit fit(cycles_, plain_.scales());
  set_start(fit, segmentation_, near.parameters.values);
  fit.parameters.level = plain_.parameters.level;
  return solved(with_kernel(fit, FreeTime::Average, near.variance_s2), FreeTime::Average);
}

/// With this time of the sensor as a parameter.
KernelSearch::Least KernelSearch::solved(const BlockFit& start, FreeTime time) const {
  BlockFit fit = with_free_time(start, time);
  if (!solve_with_damping(fit)) return {};
  const SensorTimes sensor = fit.sensor();
  const double variance_s2 = time == FreeTime::Lag ? std::pow(sensor.lag_s, 2) : std::pow(sensor.average_s, 2) / 12.0;
  return {sum_of_squares(fit), variance_s2, fit.parameters, resting_share(fit)};
}

double KernelSearch::residuals() const {
  double count = 0.0;
  for (const CycleData& cycle : cycles_->cycles()) count += static_cast<double>(cycle.residuals());
  return count;
}

BlockFit KernelSearch::with_kernel(const BlockFit& fit, FreeTime kernel, double variance_s2) const {
  Scales scales = plain_.scales();
  scales.sensor_average_s = kernel == FreeTime::Average ? std::sqrt(12.0 * variance_s2) : 0.0;
  scales.sensor_lag_s = kernel == FreeTime::Lag ? std::sqrt(variance_s2) : 0.0;
  return with_rise_after(fit.with_scales(scales));
}

/// By which ln w_n of the slips grows where an average of this variance takes its part of what is seen.
double KernelSearch::log_frequency_gain(double variance_s2) const {
  constexpr double kLeast = 0.03;
  return -0.5 * std::log(std::max(kLeast, 1.0 - variance_s2 / seen_variance_s2()));
}

/// Without a kernel.
BlockFit KernelSearch::started() const {
  BlockFit fit(cycles_, plain_.scales());
  const Coordinates& plain = plain_.parameters.values;
  Coordinates start = oscillator(plain(kLogStiffness), plain(kLogFrequency), 0.1);
  for (Eigen::Index i = 0; i < kOfSlip; ++i) {
    if (held_[static_cast<std::size_t>(i)]) start(i) = plain(i);
  }
  set_start(fit, segmentation_, start);
  fit.parameters.level = plain_.parameters.level;
  return with_rise_after(fit);
}

/// What is held at the solution: zeta at 0 where its best value is negative. Empty: no solution.
std::optional<Held> KernelSearch::solve_with_damping(BlockFit& fit) const {
  constexpr int kIterations = 12;
  constexpr double kRough = 0.1;  // SolveOptions::tolerance
  const auto solve_holding = [&](const Held& held) {
    return std::isfinite(solve(fit, {held, false, true, kIterations, kRough}));
  };
  Held undamped = held_;
  undamped[kDamping] = true;
  if (held_[kDamping]) return solve_holding(held_) ? std::optional(held_) : std::nullopt;
  double& zeta = fit.parameters.values(kDamping);
  if (zeta == 0.0 && solve_holding(undamped) && is_best_undamped(fit)) return undamped;
  if (!solve_holding(held_)) return std::nullopt;
  if (zeta >= 0.0) return held_;
  zeta = 0.0;
  return solve_holding(undamped) ? std::optional(undamped) : std::nullopt;
}

}  // namespace slipfit::fit
