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

struct Best {
  double sum = std::numeric_limits<double>::infinity();
  double length_m = 0.0;
  Globals globals{};
  std::optional<RampBend> bend{};  ///< of the sticks that are left
};

/// The length over which the rise explains some of the cycles best.
Best best_length(const Recording& recording, const Segmentation& segmentation, const BlockFit& fit, const Held& held) {
  const double speed = fit.scales().speed_m_per_s;
  const double stick_m = speed * median_stick_s(fit);
  const double shortest_m = std::max(2.0 * speed * recording.sample_interval_s(), kShortestShare * stick_m);
  const double longest_m = kLongestShare * stick_m;
  Best best;
  if (!(longest_m > shortest_m)) return best;
  std::vector<CycleData> all;
  for (std::size_t i = 0; i < fit.size(); ++i) all.push_back(fit.data(i));
  const std::vector<CycleData> cycles = spread_subset(all, kSearchedCycles);
  for (int i = 0; i < kLengths; ++i) {
    const double length_m = shortest_m * std::pow(longest_m / shortest_m, static_cast<double>(i) / (kLengths - 1));
    BlockFit trial = with_rise(fit, cycles, reloading_of(recording, segmentation, fit, length_m, false));
    if (!held[kDamping]) trial.parameters.globals[kDamping] = std::max(0.05, fit.parameters.globals[kDamping]);
    const double sum = solve(trial, {held, false, true, kSearchIterations, kRoughRise});
    if (sum < best.sum) best = {sum, length_m, trial.parameters.globals, ramp_bend(trial)};
  }
  return best;
}

/// Standard errors of A / Scales::force and ln l.
double error_of(const DampedFit& fit, Coordinate coordinate) {
  return std::sqrt(std::max(0.0, fit.uncertainty.covariance(coordinate, coordinate)));
}

/// Newton's steps in ln l, by its own column.
std::optional<DampedFit> converged(const Recording& recording, const Quality& quality, const Segmentation& segmentation,
                                   DampedFit fit) {
  for (int round = 0; round < kMostRounds; ++round) {
    const double* const rise = fit.blocks.rise_data();
    if (!(rise[0] > 0.0)) return std::nullopt;
    const double change = std::clamp(rise[1] / rise[0], -kMostLengthChange, kMostLengthChange);
    if (std::abs(change) < kSmallLengthChange * error_of(fit, kReloadLength)) return fit;
    const double length_m = fit.blocks.level().reloading->length_m * std::exp(change);
    std::vector<CycleData> cycles;
    for (std::size_t i = 0; i < fit.blocks.size(); ++i) cycles.push_back(fit.blocks.data(i));
    BlockFit next = with_rise(fit.blocks, cycles, reloading_of(recording, segmentation, fit.blocks, length_m, true));
    if (!std::isfinite(solve(next, {fit.held, false, true}))) return std::nullopt;
    std::optional<DampedFit> draft = with_uncertainty(
        {std::move(next), false, fit.held, fit.refused_damping, fit.half_width_s, fit.excluded, {}, {}},
        tolerated_misfit(quality));
    if (!draft) return std::nullopt;
    fit = *std::move(draft);
  }
  return std::nullopt;
}

bool bends(const std::optional<RampBend>& bend) {
  return bend && bend->log_ratio > std::max(thresholds::kLeastBend, thresholds::kBendSigmas * bend->standard_error);
}

/// Some of the cycles do not exclude that the rise takes half of the bend away.
bool promises(const Best& best, const RampBend& before) {
  if (!std::isfinite(best.sum) || !best.bend) return false;
  const double surely = std::abs(best.bend->log_ratio) - thresholds::kBendSigmas * best.bend->standard_error;
  return surely < thresholds::kHalvedStack * before.log_ratio;
}

/// A and l are told by this recording alone, and explain most of what bends.
bool is_justified(const Recording& recording, const DampedFit& fit, const DampedFit& plain, const RampBend& before) {
  const double rise = fit.blocks.rise_data()[0];
  const double length_m = fit.blocks.level().reloading->length_m;
  const double samples = length_m / (fit.blocks.scales().speed_m_per_s * recording.sample_interval_s());
  const std::optional<RampBend> after = ramp_bend(fit.blocks);
  const bool is_straight = after && std::abs(after->log_ratio) < thresholds::kHalvedStack * before.log_ratio;
  return is_straight && samples >= thresholds::kShapeSamples &&
         rise > thresholds::kSureTerm * error_of(fit, kReloadForce) &&
         error_of(fit, kReloadLength) < thresholds::kTellingError && gain_of(fit, plain) > thresholds::kTierPrice;
}

}  // namespace

std::optional<DampedFit> draft_with_rise(const Recording& recording, const Quality& quality,
                                         const Segmentation& segmentation, const HeldParameters& held) {
  std::optional<DampedFit> plain = draft_damped(recording, quality, segmentation, held);
  if (!plain) return plain;
  const std::optional<RampBend> bend = ramp_bend(plain->blocks);
  if (!bends(bend)) return plain;
  const Best best = best_length(recording, segmentation, plain->blocks, held_of(held));
  if (!promises(best, *bend)) return plain;
  std::optional<DampedFit> fit = draft_damped(
      recording, quality, segmentation, held,
      {best.globals, plain->excluded, reloading_of(recording, segmentation, plain->blocks, best.length_m, true),
       plain->blocks.level().per_cycle});
  if (fit) fit = converged(recording, quality, segmentation, *std::move(fit));
  const bool is_better = fit && is_justified(recording, *fit, *plain, *bend);
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
