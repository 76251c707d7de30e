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
#include "fit/selection/ramps.hpp"
#include "fit/selection/tiers.hpp"

namespace slipfit::fit {
namespace {

constexpr std::size_t kSearchedCycles = 40;  // enough to begin with
constexpr int kLengths = 6;
constexpr int kSearchIterations = 20;
constexpr double kRoughRise = 0.1;       // SolveOptions::tolerance
constexpr double kShortestShare = 0.02;  // of a stick
constexpr double kLongestShare = 0.5;
constexpr int kMostRounds = 10;
constexpr double kMostLengthChange = 0.7;   // of ln l in one round
constexpr int kMostWorse = 1;               // rounds that leave more than another
constexpr double kSmallLengthChange = 0.2;  // in standard errors

/// The rise after slips that begin and end where `fit` has them, over this length.
std::shared_ptr<const RiseAfterSlip> reloading_of(const Recording& recording, const Segmentation& segmentation,
                                                  const BlockFit& fit, double length_m, bool is_free) {
  RiseAfterSlip reloading{
      length_m, is_free, fit.scales().speed_m_per_s, recording.conditions().sensor_average_s.value_or(0.0), {}, {}};
  for (const DetectedSlip& slip : segmentation.slips) {
    reloading.slip_begin_s.push_back(recording.time_s()[slip.peak]);
    reloading.slip_end_s.push_back(recording.time_s()[slip.trough]);
  }
  for (std::size_t i = 0; i < fit.size(); ++i) {
    const CycleState state = fit.state(i);
    reloading.slip_begin_s[fit.data(i).slip] = state.onset_s;
    reloading.slip_end_s[fit.data(i).slip] = state.onset_s + state.slip_s();
  }
  return std::make_shared<const RiseAfterSlip>(std::move(reloading));
}

/// The same cycles, those of `cycles`, with another rise.
BlockFit with_rise(const BlockFit& fit, const std::vector<CycleData>& cycles,
                   std::shared_ptr<const RiseAfterSlip> reloading) {
  std::vector<double> references_s;
  std::vector<Local> locals;
  std::size_t next = 0;
  for (const CycleData& cycle : cycles) {
    while (fit.data(next).slip != cycle.slip) ++next;
    references_s.push_back(fit.reference_s(next));
    locals.push_back(fit.parameters.cycles[next]);
  }
  LevelModel level = fit.level();
  level.reloading = std::move(reloading);
  BlockFit other(cycles, std::move(references_s), fit.scales(), std::move(level));
  other.parameters.globals = fit.parameters.globals;
  other.parameters.cycles = std::move(locals);
  std::copy_n(fit.parameters.level.begin(), fit.level().terms, other.parameters.level.begin());
  return other;
}

std::vector<CycleData> cycles_of(const BlockFit& fit) {
  std::vector<CycleData> cycles;
  for (std::size_t i = 0; i < fit.size(); ++i) cycles.push_back(fit.data(i));
  return cycles;
}

double samples_over(double length_m, const Recording& recording, const DampedFit& fit) {
  return length_m / (fit.blocks.scales().speed_m_per_s * recording.sample_interval_s());
}

/// Standard errors of A / Scales::force and ln l.
double error_of(const DampedFit& fit, Coordinate coordinate) {
  return std::sqrt(std::max(0.0, fit.uncertainty.covariance(coordinate, coordinate)));
}

double length_of(const DampedFit& fit) {
  return fit.blocks.level().reloading->length_m;
}

/// A few cycles of `plain` with the rise over the length that explains them best, of several.
std::optional<DampedFit> best_of_lengths(const Recording& recording, const Segmentation& segmentation,
                                         const DampedFit& plain, const Held& held) {
  const double speed = plain.blocks.scales().speed_m_per_s;
  const double stick_m = speed * median_stick_s(plain.blocks);
  const double shortest_m = std::max(2.0 * speed * recording.sample_interval_s(), kShortestShare * stick_m);
  const double longest_m = kLongestShare * stick_m;
  std::optional<DampedFit> best;
  if (!(longest_m > shortest_m)) return best;
  const std::vector<CycleData> cycles = spread_subset(cycles_of(plain.blocks), kSearchedCycles);
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kLengths; ++i) {
    const double length_m = shortest_m * std::pow(longest_m / shortest_m, static_cast<double>(i) / (kLengths - 1));
    BlockFit trial =
        with_rise(plain.blocks, cycles, reloading_of(recording, segmentation, plain.blocks, length_m, false));
    if (!held[kDamping]) trial.parameters.globals[kDamping] = std::max(0.05, plain.blocks.parameters.globals[kDamping]);
    const double sum = solve(trial, {held, false, true, kSearchIterations, kRoughRise});
    if (!(sum < least)) continue;
    least = sum;
    best.emplace(DampedFit{std::move(trial), false, held, {}, plain.half_width_s, plain.excluded, {}, {}});
  }
  return best;
}

/// The same cycles with the rise over a length near this one that is free.
std::optional<DampedFit> with_free_length(double length_m, const Recording& recording, const Quality& quality,
                                          const Segmentation& segmentation, DampedFit fit) {
  fit.blocks =
      with_rise(fit.blocks, cycles_of(fit.blocks), reloading_of(recording, segmentation, fit.blocks, length_m, true));
  if (!std::isfinite(solve(fit.blocks, {fit.held, false, true}))) return std::nullopt;
  return with_uncertainty(std::move(fit), tolerated_misfit(quality));
}

/// Newton's steps in ln l, by its own column, while the data sample the rise and the steps lead down.
std::optional<DampedFit> converged(const Recording& recording, const Quality& quality, const Segmentation& segmentation,
                                   std::optional<DampedFit> fit) {
  double least = std::numeric_limits<double>::infinity();
  int worse = 0;
  for (int round = 0; fit && round < kMostRounds; ++round) {
    const double* const rise = fit->blocks.rise_data();
    const double length_m = length_of(*fit);
    if (!(rise[0] > 0.0) || samples_over(length_m, recording, *fit) < thresholds::kShapeSamples) return std::nullopt;
    const double change = std::clamp(rise[1] / rise[0], -kMostLengthChange, kMostLengthChange);
    const double left = fit->uncertainty.chi2;
    const double by_chance = thresholds::kTierPrice * std::pow(fit->uncertainty.noise / fit->blocks.scales().noise, 2);
    if (left > least + by_chance && ++worse > kMostWorse) return std::nullopt;
    least = std::min(least, left);
    const bool is_last = std::abs(change) < kSmallLengthChange * error_of(*fit, kReloadLength);
    fit = with_free_length(length_m * std::exp(change), recording, quality, segmentation, *std::move(fit));
    if (is_last) return fit;
  }
  return std::nullopt;
}

bool bends(const std::optional<RampBend>& bend) {
  return bend && bend->log_ratio > std::max(thresholds::kLeastBend, thresholds::kBendSigmas * bend->standard_error);
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

std::optional<DampedFit> draft_with_rise(const Recording& recording, const Quality& quality,
                                         const Segmentation& segmentation, const HeldParameters& held,
                                         const GiveUp& give_up) {
  Near from_features;
  from_features.give_up = give_up;
  std::optional<DampedFit> plain = draft_damped(recording, quality, segmentation, held, from_features);
  if (!plain) return plain;
  const std::optional<RampBend> bend = ramp_bend(plain->blocks);
  if (!bends(bend)) return plain;
  std::optional<DampedFit> few = best_of_lengths(recording, segmentation, *plain, held_of(held));
  if (!few) return plain;
  few = converged(recording, quality, segmentation,
                  with_free_length(length_of(*few), recording, quality, segmentation, *few));
  if (!few || !promises(*few, *bend)) return plain;
  std::optional<DampedFit> fit = draft_damped(
      recording, quality, segmentation, held,
      {few->blocks.parameters.globals, plain->excluded,
       reloading_of(recording, segmentation, plain->blocks, length_of(*few), true), plain->blocks.level().per_cycle});
  fit = converged(recording, quality, segmentation, std::move(fit));
  const bool is_better = fit && is_justified(*fit, *plain, *bend);
  return is_better ? std::move(fit) : std::move(plain);
}

std::optional<DampedFit> draft_with_rise_over(double length_m, const Recording& recording, const Quality& quality,
                                              const Segmentation& segmentation, const HeldParameters& held,
                                              const DampedFit& near) {
  std::optional<DampedFit> fit =
      draft_damped(recording, quality, segmentation, held,
                   {std::nullopt, near.excluded, reloading_of(recording, segmentation, near.blocks, length_m, false),
                    near.blocks.level().per_cycle});
  return fit && fit->blocks.rise_data()[0] > 0.0 ? std::move(fit) : std::nullopt;
}

}  // namespace slipfit::fit
