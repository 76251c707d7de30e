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
constexpr double kLongestShare = 0.5;    // of a stick
constexpr int kMostRounds = 10;
constexpr double kSmallLengthChange = 0.2;  // of ln l, in standard errors

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
  const double speed = fit.scales().speed_m_per_s;
  RiseAfterSlip rise{length_m, kLongestShare * speed * median_stick_s(fit), is_free, speed, {}, {}};
  for (const DetectedSlip& slip : input.segmentation.slips) {
    rise.slip_begin_s.push_back(input.recording.time_s()[slip.peak]);
    rise.slip_end_s.push_back(input.recording.time_s()[slip.trough]);
  }
  return std::make_shared<const RiseAfterSlip>(moved(std::move(rise), fit));
}

/// The same cycles at the same parameters, with a rise after these slips.
BlockFit with_rise(const BlockFit& fit, std::shared_ptr<const RiseAfterSlip> rise) {
  LevelModel level = fit.level();
  const bool is_new = level.reloading == nullptr;
  const double first = std::log(rise->length_m);
  level.reloading = std::move(rise);
  BlockFit other = fit.with_level(std::move(level), fit.scales());
  other.parameters = fit.parameters;
  if (is_new) other.parameters.values(kReloadLength) = first;
  return other;
}

/// Standard errors of A / Scales::force and ln l.
double error_of(const DampedFit& fit, Coordinate coordinate) {
  return std::sqrt(std::max(0.0, fit.uncertainty.covariance(coordinate, coordinate)));
}

double length_of(const DampedFit& fit) {
  return std::exp(fit.blocks.parameters.values(kReloadLength));
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
    BlockFit trial = with_rise(*some, rise_over(length_m, false, input, plain.blocks));
    if (!held[kDamping]) trial.parameters.values(kDamping) = std::max(0.05, plain.blocks.parameters.values(kDamping));
    const double sum = solve(trial, {held, false, true, kSearchIterations, kRoughRise});
    if (!(sum < least)) continue;
    least = sum;
    best.emplace(DampedFit{std::move(trial), false, held, {}, plain.half_width_s, plain.excluded});
  }
  return best;
}

/// With a free length of the rise, after the slips as `fit` has them.
std::optional<DampedFit> with_free_length(const Quality& quality, DampedFit fit) {
  RiseAfterSlip rise = moved(*fit.blocks.level().reloading, fit.blocks);
  rise.is_free = true;
  fit.blocks = with_rise(fit.blocks, std::make_shared<const RiseAfterSlip>(std::move(rise)));
  if (!std::isfinite(solve(fit.blocks, {fit.held, false, true}))) return std::nullopt;
  return with_uncertainty(std::move(fit), quality);
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

/// The data do not say how long the rise is.
bool is_at_bound(const DampedFit& fit) {
  constexpr double kNear = 0.99;
  return length_of(fit) > kNear * fit.blocks.level().reloading->longest_m;
}

/// A and l are told by this recording alone, and explain most of what bends.
bool is_justified(const DampedFit& fit, const DampedFit& plain, const RampBend& before) {
  const double rise = fit.blocks.parameters.values(kReloadForce);
  const std::optional<RampBend> after = ramp_bend(fit.blocks);
  const bool is_straight = after && std::abs(after->log_ratio) < thresholds::kHalvedStack * before.log_ratio;
  return is_straight && !is_at_bound(fit) && rise > thresholds::kSureTerm * error_of(fit, kReloadForce) &&
         error_of(fit, kReloadLength) < thresholds::kTellingError && gain_of(fit, plain) > thresholds::kTierPrice;
}

}  // namespace

BlockFit with_rise_after(const BlockFit& fit) {
  if (!fit.level().reloading) return fit;
  return with_rise(fit, std::make_shared<const RiseAfterSlip>(moved(*fit.level().reloading, fit)));
}

bool rises(const BlockFit& fit) {
  return !fit.level().reloading || fit.parameters.values(kReloadForce) > 0.0;
}

std::optional<DampedFit> settle_rise(const FitInput& input, std::optional<DampedFit> fit) {
  if (!fit || !fit->blocks.level().reloading || !fit->blocks.level().reloading->is_free) return fit;
  const double step_m = fit->blocks.scales().speed_m_per_s * input.recording.sample_interval_s();
  for (int round = 0; fit && round < kMostRounds; ++round) {
    const double before_m = length_of(*fit);
    if (!rises(fit->blocks) || !(before_m >= thresholds::kShapeSamples * step_m)) return std::nullopt;
    fit = with_free_length(input.quality, *std::move(fit));
    if (!fit) return fit;
    const double change = std::abs(std::log(length_of(*fit) / before_m));
    if (change < kSmallLengthChange * error_of(*fit, kReloadLength)) return fit;
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
  few = settle_rise(input, with_free_length(input.quality, *few));
  if (!few || !promises(*few, *bend)) return plain;
  std::optional<DampedFit> fit = settle_rise(
      input,
      draft_damped(input, {few->blocks.parameters.values, plain->excluded,
                           rise_over(length_of(*few), true, input, plain->blocks), plain->blocks.level().per_cycle}));
  if (!fit) return plain;
  if (is_justified(*fit, *plain, *bend)) return fit;
  const bool explains_more = gain_of(*fit, *plain) > thresholds::kTierPrice;
  if (explains_more) plain->rivals.push_back(coordinates_of(fit->blocks));
  return plain;
}

BlockFit with_free_rise(const BlockFit& fit) {
  if (!fit.level().reloading) return fit;
  RiseAfterSlip rise = *fit.level().reloading;
  rise.is_free = true;
  return with_rise(fit, std::make_shared<const RiseAfterSlip>(std::move(rise)));
}

std::optional<DampedFit> draft_with_rise_over(double length_m, const FitInput& input, const DampedFit& near) {
  std::optional<DampedFit> fit = draft_damped(
      input,
      {std::nullopt, near.excluded, rise_over(length_m, false, input, near.blocks), near.blocks.level().per_cycle});
  return fit && rises(fit->blocks) ? std::move(fit) : std::nullopt;
}

}  // namespace slipfit::fit
