#include "fit/selection/rise_term.hpp"

#include <cmath>
#include <utility>
#include <vector>

#include "core/statistics.hpp"
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

/// Returns whether the rise explains most of what bends, and more than a fit without it by the price of a term.
bool explains(const DampedFit& risen, const DampedFit& plain, const RampBend& before) {
  const std::optional<RampBend> after = ramp_bend(risen.blocks);
  const bool is_straight = after && std::abs(after->log_ratio) < thresholds::kHalvedStack * before.log_ratio;
  return is_straight && !is_at_bound(risen.blocks) && gain_of(risen, plain) > thresholds::kTierPrice;
}

/// The rise over its standard error.
double sigmas_of_rise(const DampedFit& risen) {
  return risen.blocks.parameters.values(kReloadForce) / error_of(risen, kReloadForce);
}

/// Returns whether 0 lies outside of the 95 % interval of the rise: more terms do not make the interval shorter.
bool may_be_proven(const DampedFit& risen) {
  return sigmas_of_rise(risen) > kNormalQuantile;
}

/// Returns whether the data determine A and l without more terms.
bool is_determined(const FitInput& input, const DampedFit& risen) {
  const double step_m = risen.blocks.scales().speed_m_per_s * input.recording.sample_interval_s();
  return rise_length_m(risen) >= thresholds::kSlipSamples * step_m &&
         sigmas_of_rise(risen) > thresholds::kClearSigmas &&
         error_of(risen, kReloadLength) < thresholds::kInformativeError;
}

}  // namespace

std::optional<RiseDraft> draft_with_rise(const FitInput& input, const AbortPredicate& should_abort) {
  std::optional<DampedFit> plain = draft_damped(input, should_abort);
  if (!plain) return std::nullopt;
  RiseDraft draft{*std::move(plain)};
  const std::optional<RampBend> bend = ramp_bend(draft.fit.blocks);
  if (!bends(bend, draft.fit, input.quality)) return draft;
  const std::optional<TermFitter> fitter = TermFitter::create(input, draft.fit);
  const std::vector<Minimum> minima = fitter ? fitter->minima({.rise = true}).found : std::vector<Minimum>();
  if (minima.empty() || !promises(minima.front().blocks, *bend)) return draft;
  const Minimum& best = minima.front();
  std::optional<DampedFit> risen;
  if (may_be_proven(fitter->rival_of(best))) risen = fitter->draft(best.blocks);
  if (risen && explains(*risen, draft.fit, *bend) && is_determined(input, *risen)) return RiseDraft{*std::move(risen)};
  const bool is_open = !risen || is_at_bound(best.blocks);
  const double gain = is_open ? fitter->gain_on_all(best, fitter->plain()) : gain_of(*risen, draft.fit);
  if (!(gain > thresholds::kTierPrice)) return draft;
  draft.fit.rivals.push_back(coordinates_of(is_open ? best.blocks : risen->blocks));
  if (risen && may_be_proven(*risen)) draft.unproven = std::move(risen);
  draft.bend = *bend;
  return draft;
}

bool proves_rise(const DampedFit& fit, const RiseDraft& draft) {
  return explains(fit, draft.fit, draft.bend) && sigmas_of_rise(fit) > thresholds::kLikelySigmas;
}

std::optional<DampedFit> draft_with_rise_over(double length_m, const FitInput& input, const DampedFit& plain) {
  const std::optional<TermFitter> fitter = TermFitter::create(input, plain);
  if (!fitter) return std::nullopt;
  std::optional<DampedFit> fit = fitter->draft(with_rise_over(length_m, input, plain.blocks, plain.blocks));
  return fit && rises(fit->blocks) ? std::move(fit) : std::nullopt;
}

}  // namespace slipfit::fit
