#include "fit/selection/rise_term.hpp"

#include <cmath>
#include <utility>
#include <vector>

#include "core/thresholds.hpp"
#include "fit/selection/finish.hpp"
#include "fit/selection/rise.hpp"
#include "fit/selection/term_fitter.hpp"
#include "fit/selection/tiers.hpp"

namespace slipfit::fit {
namespace {

constexpr double kFewestFalls = 3.0;  // in a period: two in a wave

/// Returns whether the sticks bend by more than chance explains, where falls are not as slow as those of waves, and an
/// early half of a stick gains more over its late half than rounding explains, which repeats its errors from stick to
/// stick.
bool bends(const std::optional<RampBend>& bend, const DampedFit& plain, const Quality& quality) {
  if (!bend || !(bend->log_ratio > thresholds::kClearSigmas * bend->standard_error)) return false;
  const Scales& scales = plain.blocks.scales();
  if (median_period_s(plain.blocks) < kFewestFalls * scales.half_period_s) return false;
  return bend->log_ratio * scales.force > tolerated_misfit(quality);
}

/// These few cycles do not exclude that the rise takes half of the bend away.
bool promises(const BlockFit& few, const RampBend& before) {
  const std::optional<RampBend> bend = ramp_bend(few);
  if (!bend) return false;
  const double surely = std::abs(bend->log_ratio) - thresholds::kClearSigmas * bend->standard_error;
  return surely < thresholds::kHalvedStack * before.log_ratio;
}

/// The data do not say how long the rise is.
bool is_at_bound(const BlockFit& fit) {
  constexpr double kNear = 0.99;
  return std::exp(fit.parameters.values(kReloadLength)) > kNear * fit.level().reloading->longest_m;
}

/// Returns whether this recording alone determines A and l, and they explain most of what bends.
bool is_justified(const DampedFit& fit, const DampedFit& plain, const RampBend& before) {
  const double rise = fit.blocks.parameters.values(kReloadForce);
  const std::optional<RampBend> after = ramp_bend(fit.blocks);
  const bool is_straight = after && std::abs(after->log_ratio) < thresholds::kHalvedStack * before.log_ratio;
  return is_straight && !is_at_bound(fit.blocks) && rise > thresholds::kClearSigmas * error_of(fit, kReloadForce) &&
         error_of(fit, kReloadLength) < thresholds::kInformativeError && gain_of(fit, plain) > thresholds::kTierPrice;
}

}  // namespace

std::optional<DampedFit> draft_with_rise(const FitInput& input, const AbortPredicate& should_abort) {
  std::optional<DampedFit> plain = draft_damped(input, should_abort);
  if (!plain) return plain;
  const std::optional<RampBend> bend = ramp_bend(plain->blocks);
  if (!bends(bend, *plain, input.quality)) return plain;
  const std::optional<TermFitter> fitter = TermFitter::create(input, *plain);
  const std::vector<Minimum> minima = fitter ? fitter->minima({.rise = true}).found : std::vector<Minimum>();
  if (minima.empty() || !promises(minima.front().blocks, *bend)) return plain;
  const Minimum& best = minima.front();
  if (is_at_bound(best.blocks)) {
    const double gain = fitter->gain_on_all(best, fitter->plain());
    if (gain > thresholds::kTierPrice) plain->rivals.push_back(coordinates_of(best.blocks));
    return plain;
  }
  std::optional<DampedFit> fit = fitter->draft(best.blocks);
  if (!fit) return plain;
  if (is_justified(*fit, *plain, *bend)) return fit;
  const bool explains_more = gain_of(*fit, *plain) > thresholds::kTierPrice;
  if (explains_more) plain->rivals.push_back(coordinates_of(fit->blocks));
  return plain;
}

std::optional<DampedFit> draft_with_rise_over(double length_m, const FitInput& input, const DampedFit& plain) {
  const std::optional<TermFitter> fitter = TermFitter::create(input, plain);
  if (!fitter) return std::nullopt;
  std::optional<DampedFit> fit = fitter->draft(with_rise_over(length_m, input, plain.blocks, plain.blocks));
  return fit && rises(fit->blocks) ? std::move(fit) : std::nullopt;
}

}  // namespace slipfit::fit
