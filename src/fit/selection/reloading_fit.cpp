#include "fit/selection/reloading_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/fit_thresholds.hpp"
#include "fit/problem/solve.hpp"
#include "fit/selection/damped_fit.hpp"
#include "fit/selection/finish.hpp"
#include "fit/selection/first_guess.hpp"
#include "fit/selection/ramps.hpp"
#include "fit/selection/tiers.hpp"

namespace slipfit::fit {
namespace {

constexpr std::size_t kSearchedCycles = 40;  // enough to begin with
constexpr double kFewestFalls = 3.0;         // in a period: two in a wave
constexpr int kLengths = 6;
constexpr int kSearchIterations = 20;
constexpr double kRoughRise = 0.1;       // SolveOptions::tolerance
constexpr double kShortestShare = 0.02;  // of a stick
constexpr double kLongestShare = 0.5;
constexpr int kMostRounds = 10;
constexpr double kMostLengthChange = 0.7;   // of ln l in one round
constexpr int kMostLarger = 2;              // steps that are larger than another before them
constexpr double kSmallLengthChange = 0.2;  // in standard errors

/// `rise` after slips that begin and end where `fit` has them. A slip that has no solution there stays where it was.
RiseAfterSlip moved(RiseAfterSlip rise, const BlockFit& fit) {
  for (std::size_t i = 0; i < fit.size(); ++i) {
    const std::optional<CycleState> state = fit.model(i).state(fit.parameters.values, fit.parameters.cycles[i].data());
    if (!state) continue;
    rise.slip_begin_s[fit.data(i).slip] = state->onset_s;
    rise.slip_end_s[fit.data(i).slip] = state->onset_s + state->slip_s();
  }
  return rise;
}

/// The rise over this length after all slips of a recording, those of `fit` where it has them.
std::shared_ptr<const RiseAfterSlip> rise_over(double length_m, bool is_free, const FitInput& input,
                                               const BlockFit& fit) {
  RiseAfterSlip rise{length_m, is_free, fit.scales().speed_m_per_s, fit.sensor().average_s, {}, {}};
  for (const DetectedSlip& slip : input.segmentation.slips) {
    rise.slip_begin_s.push_back(input.recording.time_s()[slip.peak]);
    rise.slip_end_s.push_back(input.recording.time_s()[slip.trough]);
  }
  return std::make_shared<const RiseAfterSlip>(moved(std::move(rise), fit));
}

/// The same cycles with another rise.
BlockFit with_rise(const BlockFit& fit, const Scales& scales, std::shared_ptr<const RiseAfterSlip> rise) {
  LevelModel level = fit.level();
  level.reloading = std::move(rise);
  BlockFit other = fit.with_level(std::move(level), scales);
  other.parameters.values = fit.with_scales(scales).parameters.values;
  other.parameters.cycles = fit.parameters.cycles;
  const std::size_t same = std::min(fit.parameters.level.size(), other.parameters.level.size());
  std::copy_n(fit.parameters.level.begin(), same, other.parameters.level.begin());
  return other;
}

/// Standard errors of A / Scales::force and ln l.
double error_of(const DampedFit& fit, Coordinate coordinate) {
  return std::sqrt(std::max(0.0, fit.uncertainty.covariance(coordinate, coordinate)));
}

double length_of(const DampedFit& fit) {
  return fit.blocks.level().reloading->length_m;
}

std::optional<BlockFit> some_cycles_of(const BlockFit& fit, const Segmentation& segmentation) {
  std::vector<CycleData> cycles = spread_subset(fit.set()->cycles(), kSearchedCycles);
  std::vector<double> middles = middles_s(segmentation, cycles);
  std::optional<BlockFit> some = BlockFit::create(std::move(cycles), std::move(middles), fit.scales(), fit.level());
  if (!some) return some;
  some->parameters.values = fit.parameters.values;
  some->parameters.level = fit.parameters.level;
  std::size_t same = 0;
  for (std::size_t i = 0; i < some->size(); ++i) {
    while (fit.data(same).slip != some->data(i).slip) ++same;
    some->parameters.cycles[i] = fit.parameters.cycles[same];
  }
  return some;
}

/// A few cycles of `plain` with the rise over the length that explains them best, of several.
std::optional<DampedFit> best_of_lengths(const FitInput& input, const DampedFit& plain) {
  const Held held = held_of(input.held);
  const double speed = plain.blocks.scales().speed_m_per_s;
  const double stick_m = speed * median_stick_s(plain.blocks);
  const double shortest_m = std::max(2.0 * speed * input.recording.sample_interval_s(), kShortestShare * stick_m);
  const double longest_m = kLongestShare * stick_m;
  std::optional<DampedFit> best;
  if (!(longest_m > shortest_m)) return best;
  const std::optional<BlockFit> some = some_cycles_of(plain.blocks, input.segmentation);
  if (!some) return best;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kLengths; ++i) {
    const double length_m = shortest_m * std::pow(longest_m / shortest_m, static_cast<double>(i) / (kLengths - 1));
    BlockFit trial = with_rise(*some, some->scales(), rise_over(length_m, false, input, plain.blocks));
    if (!held[kDamping]) trial.parameters.values(kDamping) = std::max(0.05, plain.blocks.parameters.values(kDamping));
    const double sum = solve(trial, {held, false, true, kSearchIterations, kRoughRise});
    if (!(sum < least)) continue;
    least = sum;
    best.emplace(DampedFit{std::move(trial), false, held, {}, plain.half_width_s, plain.excluded});
  }
  return best;
}

/// With the rise over a length that is free.
std::optional<DampedFit> with_free_length(double length_m, const Quality& quality, DampedFit fit) {
  RiseAfterSlip rise = moved(*fit.blocks.level().reloading, fit.blocks);
  rise.length_m = length_m;
  rise.is_free = true;
  fit.blocks = with_rise(fit.blocks, fit.blocks.scales(), std::make_shared<const RiseAfterSlip>(std::move(rise)));
  if (!std::isfinite(solve(fit.blocks, {fit.held, false, true}))) return std::nullopt;
  return with_uncertainty(std::move(fit), quality);
}

/// What Newton's step in ln l comes to, at most a factor of 2.
double next_length_step(const BlockFit& fit) {
  const double* const rise = fit.rise_data();
  return std::clamp(rise[1] / rise[0], -kMostLengthChange, kMostLengthChange);
}

/// Steps that each are the same share of the one before, because the slips move with the length, come to
/// 1 / (1 - share) of the next one together; the share is negative where they go back and forth.
class StepSum {
 public:
  /// What the step comes to with all that follow it, where they are foreseen: from the third on.
  double of(double step) {
    const double share = step / last_;
    const bool is_steady = std::abs(share) < kMostShare && std::abs(share - share_) < kSameShare;
    last_ = step;
    share_ = share;
    return is_steady ? step / (1.0 - share) : step;
  }

 private:
  static constexpr double kMostShare = 0.75;
  static constexpr double kSameShare = 0.15;  // twice one after the other
  double last_ = std::numeric_limits<double>::quiet_NaN();
  double share_ = std::numeric_limits<double>::quiet_NaN();
};

bool is_length_settled(const DampedFit& fit) {
  return std::abs(next_length_step(fit.blocks)) < kSmallLengthChange * error_of(fit, kReloadLength);
}

/// Beyond chance, where falls are not as slow as those of waves, and an early half of a stick gains more over its late
/// half than rounding explains, which repeats its errors from stick to stick.
bool bends(const std::optional<RampBend>& bend, const DampedFit& plain, const Quality& quality) {
  if (!bend || !(bend->log_ratio > thresholds::kBendSigmas * bend->standard_error)) return false;
  const Scales& scales = plain.blocks.scales();
  if (median_period_s(plain.blocks) < kFewestFalls * scales.half_period_s) return false;
  return bend->log_ratio * scales.force > tolerated_misfit(quality);
}

/// These few cycles do not exclude that the rise takes half of the bend away.
bool promises(const DampedFit& few, const RampBend& before) {
  const std::optional<RampBend> bend = ramp_bend(few.blocks);
  if (!bend) return false;
  const double surely = std::abs(bend->log_ratio) - thresholds::kBendSigmas * bend->standard_error;
  return surely < thresholds::kHalvedStack * before.log_ratio;
}

/// A and l are told by this recording alone, and explain most of what bends.
bool is_justified(const DampedFit& fit, const DampedFit& plain, const RampBend& before) {
  const double rise = fit.blocks.rise_data()[0];
  const std::optional<RampBend> after = ramp_bend(fit.blocks);
  const bool is_straight = after && std::abs(after->log_ratio) < thresholds::kHalvedStack * before.log_ratio;
  return is_straight && rise > thresholds::kSureTerm * error_of(fit, kReloadForce) &&
         error_of(fit, kReloadLength) < thresholds::kTellingError && gain_of(fit, plain) > thresholds::kTierPrice;
}

}  // namespace

BlockFit with_rise_after(const BlockFit& fit, const Scales& scales) {
  if (!fit.level().reloading) return fit.with_scales(scales);
  RiseAfterSlip rise = moved(*fit.level().reloading, fit);
  rise.average_s = fit.with_scales(scales).sensor().average_s;
  return with_rise(fit, scales, std::make_shared<const RiseAfterSlip>(std::move(rise)));
}

BlockFit with_length_times(const BlockFit& fit, double times) {
  if (!fit.level().reloading) return fit;
  RiseAfterSlip rise = moved(*fit.level().reloading, fit);
  rise.length_m *= times;
  return with_rise(fit, fit.scales(), std::make_shared<const RiseAfterSlip>(std::move(rise)));
}

BlockFit with_next_length(const BlockFit& fit) {
  const bool is_free = fit.level().reloading && fit.level().reloading->is_free;
  return with_length_times(fit, is_free && rises(fit) ? std::exp(next_length_step(fit)) : 1.0);
}

bool rises(const BlockFit& fit) {
  return !fit.level().reloading || fit.rise_data()[0] > 0.0;
}

std::optional<DampedFit> settle_rise(const FitInput& input, std::optional<DampedFit> fit) {
  if (!fit || !fit->blocks.level().reloading || !fit->blocks.level().reloading->is_free) return fit;
  double least_step = std::numeric_limits<double>::infinity();
  const double step_m = fit->blocks.scales().speed_m_per_s * input.recording.sample_interval_s();
  int larger = 0;
  StepSum steps;
  for (int round = 0; fit && round < kMostRounds; ++round) {
    const bool is_sampled = length_of(*fit) >= thresholds::kShapeSamples * step_m;
    if (!(fit->blocks.rise_data()[0] > 0.0) || !is_sampled) return std::nullopt;
    const double step = next_length_step(fit->blocks);
    if (std::abs(step) > least_step && ++larger > kMostLarger) return std::nullopt;
    least_step = std::min(least_step, std::abs(step));
    const bool is_last = round > 0 && is_length_settled(*fit);  // the slips may have moved since the first
    const double length_m = length_of(*fit) * std::exp(steps.of(step));
    fit = with_free_length(length_m, input.quality, *std::move(fit));
    if (is_last) return fit;
  }
  return std::nullopt;
}

std::optional<DampedFit> finish_settled(const FitInput& input, DampedFit fit) {
  std::optional<DampedFit> next = settle_rise(input, with_uncertainty(std::move(fit), input.quality));
  return next ? finish_fit(input, *std::move(next)) : std::nullopt;
}

std::optional<DampedFit> draft_with_rise(const FitInput& input, const GiveUp& give_up) {
  Near from_features;
  from_features.give_up = give_up;
  std::optional<DampedFit> plain = draft_damped(input, from_features);
  if (!plain) return plain;
  const std::optional<RampBend> bend = ramp_bend(plain->blocks);
  if (!bends(bend, *plain, input.quality)) return plain;
  std::optional<DampedFit> few = best_of_lengths(input, *plain);
  if (!few) return plain;
  few = settle_rise(input, with_free_length(length_of(*few), input.quality, *few));
  if (!few || !promises(*few, *bend)) return plain;
  std::optional<DampedFit> fit = settle_rise(
      input,
      draft_damped(input, {few->blocks.parameters.values, plain->excluded,
                           rise_over(length_of(*few), true, input, plain->blocks), plain->blocks.level().per_cycle}));
  const bool is_better = fit && is_justified(*fit, *plain, *bend);
  return is_better ? std::move(fit) : std::move(plain);
}

std::optional<DampedFit> with_free_rise(const FitInput& input, const DampedFit& fit) {
  if (!fit.blocks.level().reloading) return std::nullopt;
  return settle_rise(input, with_free_length(length_of(fit), input.quality, fit));
}

std::optional<DampedFit> draft_with_rise_over(double length_m, const FitInput& input, const DampedFit& near) {
  std::optional<DampedFit> fit = draft_damped(
      input,
      {std::nullopt, near.excluded, rise_over(length_m, false, input, near.blocks), near.blocks.level().per_cycle});
  return fit && fit->blocks.rise_data()[0] > 0.0 ? std::move(fit) : std::nullopt;
}

}  // namespace slipfit::fit
