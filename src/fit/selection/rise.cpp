#include "fit/selection/rise.hpp"

#include <cmath>
#include <memory>
#include <utility>

#include "core/fit_thresholds.hpp"
#include "fit/problem/solve.hpp"
#include "fit/selection/finish.hpp"
#include "fit/selection/tiers.hpp"

namespace slipfit::fit {
namespace {

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

/// The same cycles at the same parameters, with a rise after these slips.
BlockFit with_slips(const BlockFit& fit, RiseAfterSlip rise) {
  LevelModel level = fit.level();
  level.reloading = std::make_shared<const RiseAfterSlip>(std::move(rise));
  BlockFit other = fit.with_level(std::move(level), fit.scales());
  other.parameters = fit.parameters;
  return other;
}

/// Returns the fit with a free length of the rise, which comes after the slips as `fit` has them.
std::optional<DampedFit> with_free_length(const Quality& quality, DampedFit fit) {
  RiseAfterSlip rise = moved(*fit.blocks.level().reloading, fit.blocks);
  rise.is_free = true;
  fit.blocks = with_slips(fit.blocks, std::move(rise));
  if (!std::isfinite(solve(fit.blocks, {fit.held, false, true}))) return std::nullopt;
  return with_uncertainty(std::move(fit), quality);
}

}  // namespace

double rise_length_m(const DampedFit& fit) {
  return std::exp(fit.blocks.parameters.values(kReloadLength));
}

BlockFit with_rise_after(const BlockFit& fit) {
  if (!fit.level().reloading) return fit;
  return with_slips(fit, moved(*fit.level().reloading, fit));
}

bool rises(const BlockFit& fit) {
  return !fit.level().reloading || fit.parameters.values(kReloadForce) > 0.0;
}

BlockFit with_rise_over(double length_m, const FitInput& input, const BlockFit& slips, const BlockFit& fit) {
  const double speed = fit.scales().speed_m_per_s;
  RiseAfterSlip rise{length_m, kLongestRise * speed * median_stick_s(slips), false, speed, {}, {}};
  for (const DetectedSlip& slip : input.segmentation.slips) {
    rise.slip_begin_s.push_back(input.recording.time_s()[slip.peak]);
    rise.slip_end_s.push_back(input.recording.time_s()[slip.trough]);
  }
  BlockFit risen = with_slips(fit, moved(std::move(rise), slips));
  risen.parameters.values(kReloadLength) = std::log(length_m);
  return risen;
}

BlockFit with_free_rise(const BlockFit& fit) {
  if (!fit.level().reloading) return fit;
  RiseAfterSlip rise = *fit.level().reloading;
  rise.is_free = true;
  return with_slips(fit, std::move(rise));
}

std::optional<DampedFit> settle_rise(const FitInput& input, std::optional<DampedFit> fit) {
  if (!fit || !fit->blocks.level().reloading || !fit->blocks.level().reloading->is_free) return fit;
  const double step_m = fit->blocks.scales().speed_m_per_s * input.recording.sample_interval_s();
  for (int round = 0; fit && round < kMostRounds; ++round) {
    const double before_m = rise_length_m(*fit);
    if (!rises(fit->blocks) || !(before_m >= thresholds::kShapeSamples * step_m)) return std::nullopt;
    fit = with_free_length(input.quality, *std::move(fit));
    if (!fit) return fit;
    const double change = std::abs(std::log(rise_length_m(*fit) / before_m));
    if (change < kSmallLengthChange * error_of(*fit, kReloadLength)) return fit;
  }
  return std::nullopt;
}

std::optional<DampedFit> finish_settled(const FitInput& input, DampedFit fit) {
  std::optional<DampedFit> next = settle_rise(input, with_uncertainty(std::move(fit), input.quality));
  return next ? finish_fit(input, *std::move(next)) : std::nullopt;
}

}  // namespace slipfit::fit
