#include "slipfit/fit/fit.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/statistics.hpp"
#include "core/thresholds.hpp"
#include "fit/contact_fit.hpp"
#include "fit/cycle/cycle_data.hpp"
#include "fit/fit_unless.hpp"
#include "fit/level/hum.hpp"
#include "fit/report/recording_findings.hpp"
#include "fit/selection/chosen_fit.hpp"
#include "fit/selection/tiers.hpp"
#include "fit/sweep/sweep_data.hpp"
#include "model/reloading.hpp"

namespace slipfit {
namespace {

/// Describes where in the slip the model misses most, for readers of a warning.
std::string words_of_position(double position) {
  if (position < 0.0) return fmt::format("{:.0f} % of the slip time before its onset", -100.0 * position);
  if (position > 1.0) return fmt::format("{:.0f} % of the slip time after its end", 100.0 * (position - 1.0));
  return fmt::format("after {:.0f} % of the slip time", 100.0 * position);
}

using fit::BlockFit;
using fit::CycleState;
using fit::DampedFit;

HeldParameters held_parameters(const FitOptions& options) {
  HeldParameters held = options.held;
  if (options.tier == Tier::Undamped) held.damping_ratio = 0.0;
  return held;
}

FitDiagnostics diagnostics_of(const Recording& recording, const DampedFit& damped, const fit::Resolution& resolution) {
  const BlockFit& blocks = damped.blocks;
  const double mean = fit::mean_onset_force(damped);
  FitDiagnostics diagnostics;
  diagnostics.relative_residual = damped.uncertainty.noise / std::abs(mean);
  diagnostics.onset_force_spread = fit::spread_of_onsets(damped);
  diagnostics.onset_force_error = damped.uncertainty.onset_force_error * blocks.scales().force / std::abs(mean);
  diagnostics.restick_share = resting_share(blocks);
  diagnostics.span_share = (blocks.scales().time_end_s - blocks.scales().time_begin_s) / recording.duration_s();
  diagnostics.samples_per_slip = resolution.samples_per_slip;
  diagnostics.stick_slope_by_lines = slope_by_lines(blocks, 0.6 * median_stick_s(blocks));
  diagnostics.hum_share = mains_amplitude(blocks) / std::abs(mean);
  return diagnostics;
}

/// Marks the cycles that were offered to the fit, and warns where these are not all.
void mark_selected_cycles(const fit::OfferedSlips& offered, FitResult& result) {
  std::size_t selected = 0;
  for (std::size_t slip = 0; slip < result.cycles.size(); ++slip) {
    result.cycles[slip].selected = offered.has(slip);
    if (result.cycles[slip].selected) ++selected;
  }
  if (selected == result.cycles.size()) return;
  result.warnings.push_back({"part_of_cycles_fitted",
                             fmt::format("{} of {} cycles, in runs from the first to the last, are enough for the fit; "
                                         "fit parts of the recording with --window to use all",
                                         selected, result.cycles.size())});
}

/// Returns the period caused by this slip: slip time plus the stick time that recovers the drop, in s.
double recovery_s(const BlockFit& blocks, const CycleState& state) {
  const double straight_s = (state.z0() - state.intercept()) / state.omega_rad_per_s;
  if (!blocks.level().reloading || !(straight_s > state.slip_s()) ||
      !(blocks.parameters.values(fit::kReloadForce) > 0.0))
    return straight_s;
  const double speed = blocks.scales().speed_m_per_s;
  const double rise_m = blocks.parameters.values(fit::kReloadForce) * blocks.scales().force / state.stiffness_N_per_m;
  const double stick_m = model::reloaded_stick_m(speed * (straight_s - state.slip_s()), rise_m,
                                                 std::exp(blocks.parameters.values(fit::kReloadLength)));
  return state.slip_s() + stick_m / speed;
}

/// The table of all detected cycles, with what the fit says of those that it uses.
void tabulate(const Recording& recording, const Segmentation& segmentation, const BlockFit& blocks, FitResult& result) {
  result.cycles = fit::detected_cycles(recording, segmentation);
  mark_selected_cycles(fit::offered_slips(recording, segmentation), result);
  const std::vector<double> sums_of_squares = blocks.sums_of_squares();
  for (std::size_t c = 0; c < blocks.size(); ++c) {
    const CycleState state = blocks.state(c);
    const double* local = blocks.parameters.cycles[c].data();
    Cycle& row = result.cycles[blocks.data(c).slip];
    row.used = true;
    row.onset_s = state.onset_s;
    row.end_s = state.onset_s + state.slip_s();
    row.level_force = blocks.model(c).level_at(state.onset_s, blocks.level_data(), local);
    row.onset_force = *row.level_force + state.onset_force;
    row.recovery_s = recovery_s(blocks, state);
    row.residual_rms =
        blocks.scales().noise * std::sqrt(sums_of_squares[c] / static_cast<double>(blocks.data(c).residuals()));
  }
}

/// Curve of the chosen tier over the windows of the fitted cycles.
std::vector<CurvePoint> curve_of(const Recording& recording, const BlockFit& blocks) {
  const auto time_s = recording.time_s();
  std::vector<CurvePoint> curve;
  for (std::size_t c = 0; c < blocks.size(); ++c) {
    const CycleState state = blocks.state(c);
    const fit::StickBend bend = blocks.model(c).bend(blocks.parameters.values);
    const double* local = blocks.parameters.cycles[c].data();
    for (std::size_t i = fit::index_at(time_s, blocks.data(c).window_begin_s);
         i < time_s.size() && time_s[i] < blocks.data(c).window_end_s; ++i) {
      const double interference = blocks.model(c).hum_at(time_s[i], blocks.level_data());
      curve.push_back({i,
                       blocks.model(c).level_at(time_s[i], blocks.level_data(), local) + interference +
                           bend.at(time_s[i]) + state.force_at(time_s[i]),
                       interference});
    }
  }
  return curve;
}

Residual residual_of(const DampedFit& chosen, const Quality& quality) {
  const fit::Uncertainty& uncertainty = chosen.uncertainty;
  Residual residual;
  residual.rms = uncertainty.noise;
  if (quality.noise_rms > 0.0) {
    residual.reduced_chi2 = uncertainty.noise * uncertainty.noise / (quality.noise_rms * quality.noise_rms);
  }
  if (uncertainty.lag1_pairs > 2.0) {
    const double z = std::abs(uncertainty.lag1_correlation) * std::sqrt(uncertainty.lag1_pairs);
    residual.whiteness_p = 2.0 * normal_above(z);
  }
  return residual;
}

Warnings warnings_of(const DampedFit& chosen) {
  Warnings warnings;
  if (const auto& misfit = chosen.misfit) {
    warnings.push_back(
        {"model_misfit",
         fmt::format(
             "the slips deviate from the model in the same way in every cycle, by {:+.1f} % of the onset force {}: "
             "intervals were widened accordingly",
             100.0 * misfit->size, words_of_position(misfit->position))});
  }
  const std::vector<double>& hum_Hz = chosen.blocks.level().lines_Hz;
  if (!hum_Hz.empty()) {
    warnings.push_back(
        {"hum_fitted",
         fmt::format("interference at {:.4g} Hz was included in the fit (mains, pick-up or an uneven drive)",
                     fmt::join(hum_Hz, ", "))});
  }
  return warnings;
}

/// Merges the warnings of one code, which several parts of the fit may give, into one.
Warnings one_of_each_code(const Warnings& warnings) {
  Warnings merged;
  for (const Warning& warning : warnings) {
    const auto same =
        std::find_if(merged.begin(), merged.end(), [&](const Warning& w) { return w.code == warning.code; });
    if (same == merged.end()) {
      merged.push_back(warning);
    } else {
      same->message += "; " + warning.message;
    }
  }
  return merged;
}

}  // namespace

std::optional<FitResult> fit::fit_unless(const std::function<bool()>& is_other_kept, const Recording& recording,
                                         const Quality& quality, const Segmentation& segmentation,
                                         const FitOptions& options) {
  if (recording.conditions().force_view == ForceView::Contact) return fit_contact(recording, segmentation, options);
  const HeldParameters held = held_parameters(options);
  AbortPredicate should_abort;
  if (is_other_kept) {
    should_abort = [&](const BlockFit& some) { return reduced_chi2(some) > thresholds::kLargeChi2 && is_other_kept(); };
  }
  const std::optional<Chosen> chosen_of =
      choose_with_ring_down({recording, quality, segmentation, held}, options, should_abort);
  if (!chosen_of) return std::nullopt;
  const auto& [fits, resolution, candidates, of_choice] = *chosen_of;

  FitResult result;
  result.candidates = candidates;
  for (const Candidate& candidate : result.candidates) {
    if (candidate.chosen) result.tier = candidate.tier;
  }
  const DampedFit* undamped_fit = fits.without_damping();
  const DampedFit& chosen = result.tier == Tier::Undamped && undamped_fit != nullptr ? *undamped_fit : fits.damped;
  result.diagnostics = diagnostics_of(recording, fits.damped, resolution);
  result.conditional_on = fit::conditions_of(recording, result.tier);
  result.residual = residual_of(chosen, quality);
  if (fits.damped.motion) result.conditional_on.emplace_back(fit::kRingDown);
  result.mass_gives_frequency = fits.damped.mass_gives_frequency;
  fit::report_parameters(fit::findings_of(recording, fits, resolution, result.residual), result);
  tabulate(recording, segmentation, chosen.blocks, result);
  for (const Warnings& warnings : {warnings_of(chosen), of_choice}) {
    result.warnings.insert(result.warnings.end(), warnings.begin(), warnings.end());
  }
  result.warnings = one_of_each_code(result.warnings);
  if (options.curve) result.curve = curve_of(recording, chosen.blocks);
  return result;
}

std::optional<fit::RoughMisfit> fit::rough_misfit(const FitInput& few) {
  const std::optional<BlockFit> fit = rough_fit(few);
  if (!fit) return std::nullopt;
  std::vector<double> onset_forces;
  for (const Local& local : fit->parameters.cycles) onset_forces.push_back(local[1]);
  const MeanAndSpread onset = describe(onset_forces);
  const Scales& scales = fit->scales();
  return RoughMisfit{scales.noise * std::sqrt(reduced_chi2(*fit)) / std::abs(scales.force * onset.mean),
                     onset.sd / std::abs(onset.mean), fit->size()};
}

std::optional<FitResult> fit_recording(const Recording& recording, const Quality& quality,
                                       const Segmentation& segmentation, const FitOptions& options) {
  return fit::fit_unless({}, recording, quality, segmentation, options);
}

}  // namespace slipfit
