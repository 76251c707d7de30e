#include "fit/selection/fitted_average.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "core/fit_thresholds.hpp"
#include "core/thresholds.hpp"
#include "fit/cycle/start.hpp"
#include "fit/inference/smoothing.hpp"
#include "fit/problem/solve.hpp"
#include "fit/selection/damped_fit.hpp"
#include "fit/selection/tiers.hpp"
#include "signal/robust.hpp"

namespace slipfit::fit {
namespace {

/// Shapes of an instrument's impulse response with the same variance sigma^2.
enum class Kernel { MovingAverage, FirstOrder };

Recording seen_through(const Recording& recording, Kernel kernel, double variance_s2) {
  Conditions conditions = recording.conditions();
  if (kernel == Kernel::MovingAverage) {
    conditions.sensor_average_s = std::sqrt(12.0 * variance_s2);
  } else {
    conditions.sensor_bandwidth_Hz = 1.0 / (2.0 * std::numbers::pi * std::sqrt(variance_s2));
  }
  const auto time_s = recording.time_s();
  const auto force = recording.force();
  return Recording::create({time_s.begin(), time_s.end()}, {force.begin(), force.end()}, conditions,
                           recording.provenance())
      .value();
}

/// Median time from the end of one slip to the onset of the next.
double stick_s(const BlockFit& blocks) {
  std::vector<double> sticks_s;
  for (std::size_t i = 0; i + 1 < blocks.size(); ++i) {
    if (!blocks.data(i).continuous_with_next) continue;
    const CycleState state = blocks.state(i);
    sticks_s.push_back(blocks.state(i + 1).onset_s - state.onset_s - state.slip_s());
  }
  return signal::median(std::move(sticks_s));
}

/// Where the search for W begins; empty without a sign of averaging. The sum of squares may have two minima, one of
/// much averaging, where the time of the fall is W's, and one of little with slips that are too slow.
std::vector<double> guesses_s(const Recording& recording, const DampedFit& plain) {
  const BlockFit& blocks = plain.blocks;
  const double step_s = recording.sample_interval_s();
  const double of_fall_s = 0.7 * blocks.scales().half_period_s;
  const std::optional<Smoothing>& seen = plain.rounding;
  if (!seen) return {};
  const double surely_s2 = seen->variance_s2 - thresholds::kRoundedSigmas * seen->standard_error_s2;
  if (!(surely_s2 > step_s * step_s / 12.0)) return {};
  if (plain.refused_damping) return {of_fall_s};
  return {std::sqrt(12.0 * seen->variance_s2), of_fall_s};
}

/// Every so many samples around the slip, so that few are left; sticks as they are.
CycleData thinned(CycleData cycle) {
  constexpr std::size_t kSamples = 100;  // of four half periods: enough for the shape, and 10 cycles for the noise
  const std::size_t stride = 1 + cycle.time_s.size() / kSamples;
  const auto thin = [&](auto& values) {
    for (std::size_t i = 0; i * stride < values.size(); ++i) values[i] = values[i * stride];
    values.resize((values.size() + stride - 1) / stride);
  };
  thin(cycle.samples);
  thin(cycle.time_s);
  thin(cycle.force);
  thin(cycle.weight);
  return cycle;
}

/// The search for W on some of the cycles, from the features of the slips.
class Probe {
 public:
  Probe(const Recording& recording, const Segmentation& segmentation, const HeldParameters& held,
        const DampedFit& plain)
      : segmentation_(segmentation),
        held_(held_of(held)),
        step_s_(recording.sample_interval_s()),
        plain_(plain.blocks),
        plain_misfit_(plain.misfit) {
    const Scales& scales = plain_.scales();
    const HumLines hum{plain_.level().lines_Hz, scales.time_begin_s};
    // Those that the fit could use, with room for an average over the whole fall on either side.
    std::vector<std::size_t> used;
    for (std::size_t i = 0; i < plain_.size(); ++i) used.push_back(plain_.data(i).slip);
    std::vector<CycleData> cycles =
        cut_cycles(recording, segmentation, 2.0 * scales.half_period_s, plain.excluded, hum);
    std::erase_if(cycles,
                  [&](const CycleData& cycle) { return !std::binary_search(used.begin(), used.end(), cycle.slip); });
    cycles = spread_subset(cycles, kProbeCycles);
    std::transform(cycles.begin(), cycles.end(), cycles.begin(), thinned);
    std::vector<double> middles_s;
    for (const CycleData& cycle : cycles) middles_s.push_back(segmentation.slips[cycle.slip].middle_s);
    cycles_ = std::make_shared<CycleSet>(std::move(cycles), std::move(middles_s), plain_.level(), scales);
  }

  /// Newton's steps in W^2, none by more than a factor of 4, until they are small or within the error; empty where they
  /// do not get smaller.
  [[nodiscard]] std::optional<double> converge(double average_s) const {
    constexpr int kMostSteps = 6;
    double last_step = std::numeric_limits<double>::infinity();
    BlockFit fit = started(average_s);
    for (int step = 0; step < kMostSteps; ++step) {
      const std::optional<Held> held = solve_with_damping(fit);
      if (!held || (step == 0 && !misses_less(fit, kWorthMoreSteps))) return std::nullopt;
      const std::optional<Smoothing> beyond = estimate_smoothing(fit, *held, step_s_);
      if (!beyond) return std::nullopt;
      const double square = average_s * average_s;
      const double next = std::clamp(square + 12.0 * beyond->variance_s2, 0.25 * square, 4.0 * square);
      const double change = std::abs(std::log(next / square));
      average_s = std::sqrt(next);
      if (average_s < step_s_ || average_s > 2.0 * plain_.scales().half_period_s) return std::nullopt;
      if (change < kSmallStep || std::abs(beyond->variance_s2) < beyond->standard_error_s2) {
        return misses_less(fit, kWorthAllCycles) ? std::optional(average_s) : std::nullopt;
      }
      if (change > kShrinking * last_step) return std::nullopt;
      last_step = change;
      fit = with_average(fit, average_s);
    }
    return std::nullopt;
  }

 private:
  static constexpr std::size_t kProbeCycles = 10;
  static constexpr double kSmallStep = 0.05;
  static constexpr double kShrinking = 0.8;
  static constexpr double kWorthMoreSteps = 0.75;  // misfit over that of the plain fit
  static constexpr double kWorthAllCycles = 0.5;

  /// Of the mean shape of the slips less than this share of what the plain fit misses.
  [[nodiscard]] bool misses_less(const BlockFit& fit, double share) const {
    const std::optional<SegmentMisfit> misfit = find_misfit(fit, 0.0);
    return !misfit || !plain_misfit_ || std::abs(misfit->size) < share * std::abs(plain_misfit_->size);
  }

  [[nodiscard]] BlockFit with_average(const BlockFit& fit, double average_s) const {
    Scales scales = plain_.scales();
    scales.sensor_average_s = average_s;
    BlockFit next(cycles_, scales);
    next.parameters = fit.parameters;
    return next;
  }

  /// Averaging draws the fall out: the squares of its own time and of W add up.
  [[nodiscard]] BlockFit started(double average_s) const {
    constexpr double kLeast = 0.2;
    const double half_s = plain_.scales().half_period_s;
    const double own = std::max(kLeast, 1.0 - average_s * average_s / (half_s * half_s));
    BlockFit fit(cycles_, plain_.scales());
    set_start(fit, segmentation_,
              {plain_.parameters.globals[kLogStiffness], std::log(std::numbers::pi / (half_s * std::sqrt(own))), 0.1});
    fit.parameters.level = plain_.parameters.level;
    return with_average(fit, average_s);
  }

  /// What is held at the solution: zeta at 0 where its best value is negative. Empty: no solution.
  [[nodiscard]] std::optional<Held> solve_with_damping(BlockFit& fit) const {
    constexpr int kIterations = 25;
    constexpr double kRough = 0.1;  // SolveOptions::tolerance
    Held held = held_;
    if (!std::isfinite(solve(fit, {held, false, true, kIterations, kRough}))) return std::nullopt;
    if (held[kDamping] || fit.parameters.globals[kDamping] >= 0.0) return held;
    fit.parameters.globals[kDamping] = 0.0;
    held[kDamping] = true;
    if (!std::isfinite(solve(fit, {held, false, true, kIterations, kRough}))) return std::nullopt;
    return held;
  }

  const Segmentation& segmentation_;
  Held held_;
  double step_s_;
  const BlockFit& plain_;
  const std::optional<SegmentMisfit>& plain_misfit_;
  std::shared_ptr<const CycleSet> cycles_;
};

/// A fit of all cycles with a kernel in it, and what is left to smooth.
struct Trial {
  DampedFit fit;
  Smoothing beyond;
  double variance_s2 = 0.0;

  /// In standard errors.
  [[nodiscard]] double off() const { return std::abs(beyond.variance_s2) / beyond.standard_error_s2; }
};

/// Fits of all cycles with a kernel of about the given variance.
class Trials {
 public:
  Trials(const Recording& recording, const Quality& quality, const Segmentation& segmentation,
         const HeldParameters& held)
      : recording_(recording), quality_(quality), segmentation_(segmentation), held_(held) {}

  /// Newton's steps in sigma^2; where outliers come and go with it they do not settle, and the nearest is taken.
  [[nodiscard]] std::optional<Trial> fit(Kernel kernel, double variance_s2) const {
    constexpr int kMostFits = 3;
    std::optional<Trial> best;
    for (int fits = 0; fits < kMostFits && variance_s2 > 0.0; ++fits) {
      auto fit = fit_damped(seen_through(recording_, kernel, variance_s2), quality_, segmentation_, held_);
      if (!fit) break;
      const auto beyond = estimate_smoothing(fit->blocks, fit->held, recording_.sample_interval_s());
      if (!beyond) break;
      Trial trial{std::move(*fit), *beyond, variance_s2};
      if (!best || trial.off() < best->off()) best = std::move(trial);
      if (best->fit.misfit || best->off() < thresholds::kSettledAverage) break;
      variance_s2 += beyond->variance_s2;
    }
    return best;
  }

 private:
  const Recording& recording_;
  const Quality& quality_;
  const Segmentation& segmentation_;
  const HeldParameters& held_;
};

double resting_share(const BlockFit& blocks) {
  double resting = 0.0;
  for (std::size_t i = 0; i < blocks.size(); ++i) resting += blocks.state(i).motion.slip.resticks ? 1.0 : 0.0;
  return resting / static_cast<double>(blocks.size());
}

/// Twice the logarithm of the likelihood of one fit over that of another, each at its best noise.
double gain_of(const DampedFit& fit, const DampedFit& other) {
  return 2.0 * effective_samples(other) * std::log(other.uncertainty.noise / fit.uncertainty.noise);
}

/// Slips and W can be told apart, and the slips that are left behind W are those of the model.
bool tells_slips(const DampedFit& fit) {
  const double damping_error = std::sqrt(std::max(0.0, fit.uncertainty.covariance(kDamping, kDamping)));
  return !fit.misfit && !fit.refused_damping && damping_error < thresholds::kTellingDamping &&
         fit.average->seconds > thresholds::kSureTerm * fit.average->standard_error_s &&
         fit.average->seconds < stick_s(fit.blocks) && resting_share(fit.blocks) >= thresholds::kRestickShare;
}

/// With what W is not known by in the covariance.
DampedFit with_average_error(Trial trial) {
  const double error_s2 = std::hypot(trial.beyond.standard_error_s2, trial.beyond.variance_s2,
                                     thresholds::kKernelShape * trial.variance_s2);
  const double average_s = std::sqrt(12.0 * trial.variance_s2);
  trial.fit.average = FittedAverage{average_s, 6.0 * error_s2 / average_s};
  trial.fit.uncertainty.covariance +=
      error_s2 * error_s2 * trial.beyond.move_per_s2 * trial.beyond.move_per_s2.transpose();
  return std::move(trial.fit);
}

}  // namespace

std::optional<DampedFit> fit_average(const Recording& recording, const Quality& quality,
                                     const Segmentation& segmentation, const HeldParameters& held,
                                     const DampedFit& plain) {
  const std::vector<double> guesses = guesses_s(recording, plain);
  if (guesses.empty()) return std::nullopt;
  const Probe probe(recording, segmentation, held, plain);
  const Trials trials(recording, quality, segmentation, held);
  std::optional<Trial> best;
  for (const double guess_s : guesses) {
    const std::optional<double> average_s = probe.converge(guess_s);
    if (!average_s) continue;
    std::optional<Trial> trial = trials.fit(Kernel::MovingAverage, *average_s * *average_s / 12.0);
    if (!trial || (best && best->fit.uncertainty.noise <= trial->fit.uncertainty.noise)) continue;
    best = std::move(trial);
  }
  if (!best) return std::nullopt;
  const double variance_s2 = best->variance_s2;
  DampedFit fit = with_average_error(*std::move(best));
  if (!tells_slips(fit) || gain_of(fit, plain) < thresholds::kTierPrice) return std::nullopt;
  // A long tail rounds the slip less than its variance says: the search begins on both sides of it.
  bool compared = false;
  for (const double share : {1.0, 3.0}) {
    const std::optional<Trial> lagging = trials.fit(Kernel::FirstOrder, share * variance_s2);
    if (!lagging) continue;
    compared = true;
    if (gain_of(fit, lagging->fit) < thresholds::kEvidence) return std::nullopt;
  }
  return compared ? std::optional(std::move(fit)) : std::nullopt;
}

}  // namespace slipfit::fit
