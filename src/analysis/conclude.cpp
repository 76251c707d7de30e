#include "analysis/conclude.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "analysis/audit.hpp"
#include "analysis/conclusions.hpp"
#include "analysis/ranges.hpp"
#include "analysis/rules.hpp"
#include "analysis/sweep_checks.hpp"
#include "core/unknown.hpp"
#include "fit/cycle/cycle_data.hpp"
#include "fit/report/recording_findings.hpp"
#include "slipfit/surface/comparison.hpp"

namespace slipfit {
namespace {

/// Returns the fit without the results that the rest of the analysis rules out: it has no parameters where the motion
/// is not that of the model and no natural frequency where inertia does not determine the slips, and it identifies
/// nothing where the cycles are synchronous with the mains or sticks are not proven.
std::optional<FitResult> qualify(std::optional<FitResult> fit, const Classification& classification,
                                 const Analysis& analysis, double duration_s) {
  if (!fit) return fit;
  if (!classification.model_fits) return fit::without_parameters(*std::move(fit));
  const std::optional<double>& ring_Hz = analysis.transients.ring_down_frequency_Hz.value;
  const std::optional<double>& slips_Hz = analysis.frequency.quoted.value;
  const std::optional<double>& drop = analysis.cycles.force_drop;
  if (ring_Hz && drop) fit = fit::qualified_by_ring_down(*std::move(fit), *ring_Hz, *drop);
  if (slips_Hz) fit = fit::qualified_by_mains(*std::move(fit), *slips_Hz, duration_s);
  if (!classification.caveat.empty()) fit = fit::without_identified(*std::move(fit), classification.caveat);
  return fit;
}

/// Adds the comparison of the worn track with the spacing V / f of the force.
Derived with_worn_track(Derived derived, const Conditions& conditions) {
  if (!conditions.worn_track) return derived;
  SpacingComparison compared = compare_spacings(derived.pattern_spacing_m, conditions.worn_track->spacing_m);
  derived.surface_spacing_m = conditions.worn_track->spacing_m;
  derived.surface_ratio = std::move(compared.ratio);
  derived.surface_En = std::move(compared.En);
  derived.surface_verdict = std::move(compared.verdict);
  return derived;
}

/// Returns the quantities that follow from the fit and the measurement at the recording's own speed. An oscillation
/// that dies out leaves no pattern.
Derived derive(const Recording& recording, const Analysis& analysis, bool dies_out) {
  Derived derived;
  if (analysis.fit) derived = derive_from_model(*analysis.fit, recording.conditions());
  if (!analysis.fit && recording.conditions().measured_spacing_m) {
    derived.measured_spacing_En = unknown("needs a fitted model");
  }
  if (dies_out) {
    derived.pattern_spacing_m = derived.impulse_rate_per_m = unknown("the oscillation decays and leaves no pattern");
  } else {
    derived = with_measured_spacing(std::move(derived), recording, analysis.frequency, analysis.cycles);
  }
  return in_range(with_worn_track(std::move(derived), recording.conditions()));
}

void append(Warnings& warnings, const Warnings& more) {
  warnings.insert(warnings.end(), more.begin(), more.end());
}

/// Returns the analysis in which values that contradict each other are not identified, with what follows from them
/// derived again.
Analysis audited(const Recording& recording, Analysis analysis, bool dies_out) {
  if (!analysis.fit) return analysis;
  analysis.audit = audit_of(recording, analysis, *analysis.fit);
  const auto contradicts = [](const AuditPair& pair) { return pair.contradicts; };
  if (std::none_of(analysis.audit.begin(), analysis.audit.end(), contradicts)) return analysis;
  analysis.fit = with_audit(*std::move(analysis.fit), analysis.audit);
  analysis.frequency = with_audit(std::move(analysis.frequency), analysis.audit);
  analysis.derived = with_audit(derive(recording, analysis, dies_out), analysis.audit);
  return analysis;
}

/// The fitted curve counts its samples in the part that slides: converted to samples of the whole recording.
std::optional<FitResult> curve_in_recording_samples(std::optional<FitResult> fit, const Detected& detected) {
  if (!fit) return fit;
  for (CurvePoint& point : fit->curve) point.sample = detected.sample_of(point.sample);
  return fit;
}

}  // namespace

Analysis conclude(const Detected& detected, Estimates& estimates, Classification classification) {
  const Recording& recording = detected.recording();
  const Segmentation& slips = estimates.signals.segmentation;
  const FitResult* const fit = estimates.fit ? &*estimates.fit : nullptr;
  Analysis analysis;
  analysis.sliding = {recording.time_s().front(), recording.time_s().back()};
  analysis.quality = detected.whole_quality;
  analysis.frequency = in_range(
      quote_frequency(recording, estimates.signals, classification, classification.model_fits ? fit : nullptr));
  analysis.cycles = in_range(summarise_cycles(recording, slips, fit));
  if (estimates.drive) {
    analysis.drive = {estimates.drive->recording.conditions().speed_m_per_s, estimates.drive->share_in_slips};
    analysis.cycles.stick_stiffness = estimates.drive->stiffness_N_per_m;
    analysis.cycles.other_sticks = {};  // their slopes are those of the drive
  }
  if (analysis.cycles.period_cv) {
    analysis.cycles.regularity = regularity_of(analysis.cycles, analysis.frequency.quoted, recording.conditions());
  }
  analysis.cycle_table = fit != nullptr ? fit->cycles : fit::detected_cycles(recording, slips);
  analysis.transients = in_range(find_transients(detected, classification.motion));
  analysis.fit = qualify(std::exchange(estimates.fit, std::nullopt), classification, analysis, recording.duration_s());
  analysis.motion = classification.motion;
  analysis.motion_reason = std::move(classification.reason);
  analysis.coefficients = in_range(find_coefficients(detected, analysis));
  analysis.derived = derive(recording, analysis, classification.dies_out);
  analysis.tests = run_short_tests(recording, analysis);
  analysis = audited(recording, std::move(analysis), classification.dies_out);
  analysis.warnings = collect_warnings({detected, slips, analysis});
  if (analysis.fit) analysis.fit = limited_by(analysis.warnings, *std::move(analysis.fit));
  analysis.fit = curve_in_recording_samples(std::move(analysis.fit), detected);
  analysis.timing.frequency_s = detected.seconds + estimates.frequency_s;
  analysis.timing.fit_s = estimates.fit_s;
  return analysis;
}

Analysis without_falls(Analysis analysis) {
  if (analysis.motion != MotionClass::SteadySliding) return analysis;
  const Estimate none = unknown("steady sliding has no slips");
  analysis.cycles = CycleStatistics{};
  analysis.cycles.stick_stiffness = analysis.frequency.counted = none;
  for (Cycle& cycle : analysis.cycle_table) cycle.used = false;
  return analysis;
}

namespace {

/// The warnings of the sweep and of the recordings in its fit.
Warnings all_warnings(const SweepAnalysis& sweep) {
  Warnings warnings = sweep.warnings;
  for (std::size_t i = 0; i < sweep.recordings.size(); ++i) {
    if (sweep.roles[i] == SweepRole::Cycles) append(warnings, sweep.recordings[i].warnings);
  }
  return warnings;
}

/// Returns the sweep in which a shared value is not identified if it contradicts one of the recordings.
SweepAnalysis audited(std::span<const SweepEntry> entries, SweepAnalysis sweep) {
  std::vector<AuditPair> shared;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    std::vector<AuditPair>& audit = sweep.audits.emplace_back();
    if (sweep.roles[i] == SweepRole::Cycles) audit = joint_audit_of(entries[i], sweep.recordings[i], sweep.fit->result);
    shared.insert(shared.end(), audit.begin(), audit.end());
  }
  sweep.fit->result = with_audit(std::move(sweep.fit->result), shared);
  append(sweep.fit->result.warnings, warn_of(shared));
  return sweep;
}

}  // namespace

SweepAnalysis conclude_sweep(std::span<const SweepEntry> entries, SweepAnalysis sweep) {
  sweep.fit = in_range(std::move(sweep.fit));
  if (sweep.fit) sweep = audited(entries, std::move(sweep));
  const FitResult result = sweep.fit ? sweep.fit->result : FitResult{};
  sweep.derived = in_range(derive_from_sweep(result, observed_end(entries, sweep.recordings, result)));
  sweep.fit_reason = describe_roles(sweep.roles);
  sweep.repeats = compare_repeats(entries, sweep.recordings);
  sweep.warnings = check_frequency_follows_speed(entries, sweep.recordings);
  sweep.recordings = without_passing_patterns(std::move(sweep.recordings), sweep.warnings);
  append(sweep.warnings, check_level_repeats(entries, sweep.recordings));
  append(sweep.warnings, check_duplicates(entries));
  append(sweep.warnings, check_resolution(entries, sweep.recordings, sweep.roles));
  if (sweep.fit) {
    append(sweep.warnings, check_agreement(entries, sweep.recordings, *sweep.fit));
    append(sweep.warnings, sweep.fit->result.warnings);
    sweep.fit->result = limited_by(by_effect(all_warnings(sweep)), std::move(sweep.fit->result));
  }
  sweep.warnings = by_effect(std::move(sweep.warnings));
  for (Analysis& analysis : sweep.recordings) analysis = without_falls(std::move(analysis));
  return sweep;
}

}  // namespace slipfit
