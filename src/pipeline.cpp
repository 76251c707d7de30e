#include "slipfit/pipeline.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <future>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "fit/cycle/cycle_table.hpp"
#include "fit/selection/qualify.hpp"
#include "measured.hpp"
#include "ranges.hpp"
#include "recording_checks.hpp"
#include "signals.hpp"
#include "slip_counts.hpp"
#include "slipfit/sweep.hpp"
#include "sweep_checks.hpp"
#include "verdict.hpp"

namespace slipfit {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// How badly the cycles fit: residual and spread over the onset force. A missing fit is the worst; so is one that finds
/// cycles in less than half of the slips offered to it, which are then no slips: a rhythm near the mains that was taken
/// out as hum leaves such remains behind.
double misfit_of(const std::optional<FitResult>& fit) {
  if (!fit) return std::numeric_limits<double>::infinity();
  const std::vector<Cycle>& cycles = fit->cycles;
  const auto used = std::count_if(cycles.begin(), cycles.end(), [](const Cycle& cycle) { return cycle.used; });
  const auto offered =
      std::count_if(cycles.begin(), cycles.end(), [](const Cycle& cycle) { return !cycle.left_aside; });
  if (2 * used < offered) return std::numeric_limits<double>::infinity();
  return fit->evidence.relative_residual + 0.3 * fit->evidence.onset_force_spread;
}

Analysis conclude(const Recording& recording, Signals signals, Judgement judgement, std::optional<FitResult> fit) {
  Analysis analysis;
  analysis.verdict = judgement.verdict;
  analysis.verdict_reason = std::move(judgement.reason);
  if (fit) fit = in_range(*std::move(fit), recording.conditions());
  const FitResult* const cycles_of = judgement.model_fits ? &*fit : nullptr;
  analysis.frequency = in_range(report_frequency(recording, signals, judgement.verdict, cycles_of));
  analysis.cycles = in_range(summarise_cycles(recording, signals.segmentation, fit ? &*fit : nullptr));
  analysis.cycle_table = fit ? fit->cycles : fit::detected_cycles(recording, signals.segmentation);
  if (fit && !judgement.model_fits) fit = fit::without_parameters(*std::move(fit));
  if (fit && judgement.model_fits && analysis.frequency.quoted.value) {
    fit = fit::qualified_by_mains(*std::move(fit), *analysis.frequency.quoted.value, recording.duration_s());
  }
  if (fit) analysis.derived = derive_from_model(*fit, recording.conditions());
  if (!fit && recording.conditions().measured_spacing_m) {
    analysis.derived.measured_spacing_En = Estimate{{}, {}, {}, "needs a fitted model"};
  }
  add_measured_spacing(recording, analysis.frequency, analysis.cycles, analysis.derived);
  analysis.derived = in_range(std::move(analysis.derived));
  analysis.quality = std::move(signals.quality);
  analysis.fit = std::move(fit);
  analysis.tests = run_short_tests(recording, analysis);
  analysis.warnings = collect_warnings(recording, analysis);
  if (analysis.verdict == Verdict::StickSlip) {
    for (Warning& warning : warn_of_changes(recording, signals.segmentation)) {
      analysis.warnings.push_back(std::move(warning));
    }
  }
  analysis.timing.frequency_s = signals.seconds;
  return analysis;
}

/// A fit and the signals that it rests on.
struct Fitted {
  Signals signals;
  std::optional<FitResult> fit;
  double seconds = 0.0;
};

/// Another fit where hum of the mains may have hidden slips or made some. Lines in the level take up some noise by
/// themselves: it has to be clearly better.
void look_beneath_hum(const Recording& recording, const FitOptions& options, Fitted& fitted) {
  Signals& signals = fitted.signals;
  std::optional<Segmentation> beneath = find_slips_beneath_hum(recording, signals.quality, signals.segmentation);
  if (!beneath) return;
  std::optional<FitResult> other = fit_recording(recording, signals.quality, *beneath, options);
  constexpr double kClearlyBetter = 0.95;
  if (!(misfit_of(other) < kClearlyBetter * misfit_of(fitted.fit))) return;
  signals.segmentation = std::move(*beneath);
  signals.spectral = look_at_spectrum(recording, signals).spectral;
  fitted.fit = std::move(other);
}

/// The spectrum is judged beside the fit, in a thread where one is to be had.
Fitted fit_signals(const Recording& recording, Signals signals, const FitOptions& options) {
  constexpr std::size_t kLarge = 1000000;  // the arrays of spectrum and fit together would be large
  Fitted fitted;
  fitted.signals = std::move(signals);
  // Named, and so copied: where there is no thread, async begins anew with what it was given.
  const auto look_meanwhile = [&] { return look_at_spectrum(recording, fitted.signals); };
  std::future<SpectrumLook> look = std::async(look_meanwhile);
  if (recording.size() >= kLarge) look.wait();
  const auto fit_start = Clock::now();
  fitted.fit = fit_recording(recording, fitted.signals.quality, fitted.signals.segmentation, options);
  SpectrumLook looked = look.get();
  fitted.signals.spectral = std::move(looked.spectral);
  fitted.signals.seconds += looked.seconds;
  if (may_be_hum(fitted.signals)) look_beneath_hum(recording, options, fitted);
  fitted.seconds = seconds_since(fit_start);
  return fitted;
}

/// What was found in the stretch that slides, told of the whole recording.
Analysis told_of_whole(Analysis analysis, const Recording& recording, Sliding sliding) {
  const std::span<const double> used = sliding.of(recording).time_s();
  analysis.sliding = {used.front(), used.back()};
  analysis.quality = std::move(sliding.whole_quality);
  if (analysis.fit) {
    for (CurvePoint& point : analysis.fit->curve) point.sample += sliding.begin;
  }
  return analysis;
}

Analysis judge_and_conclude(const Recording& recording, Sliding sliding, Fitted fitted) {
  const Recording& used = sliding.of(recording);
  const Signals& signals = fitted.signals;
  Judgement judgement = judge_fit(used, signals.segmentation, signals.spectral, fitted.fit ? &*fitted.fit : nullptr);
  Analysis analysis = conclude(used, std::move(fitted.signals), std::move(judgement), std::move(fitted.fit));
  analysis.timing.fit_s = fitted.seconds;
  return told_of_whole(std::move(analysis), recording, std::move(sliding));
}

/// The fit tells at least one parameter.
bool has_values(const Analysis& analysis) {
  return analysis.fit && std::any_of(analysis.fit->parameters.begin(), analysis.fit->parameters.end(),
                                     [](const Parameter& parameter) { return parameter.estimate.value.has_value(); });
}

}  // namespace

Analysis analyze(const Recording& recording) {
  Sliding sliding = find_sliding(recording);
  const Recording& used = sliding.of(recording);
  Signals signals = sliding.signals;
  SpectrumLook looked = look_at_spectrum(used, signals);
  signals.spectral = std::move(looked.spectral);
  signals.seconds += looked.seconds;
  Judgement judgement = judge_shape(used, signals.segmentation, signals.spectral);
  Analysis analysis = conclude(used, std::move(signals), std::move(judgement), std::nullopt);
  return told_of_whole(std::move(analysis), recording, std::move(sliding));
}

Analysis analyze_and_fit(const Recording& recording, const FitOptions& options) {
  Sliding sliding = find_sliding(recording);
  Fitted fitted = fit_signals(sliding.of(recording), sliding.signals, options);
  return judge_and_conclude(recording, std::move(sliding), std::move(fitted));
}

SweepAnalysis analyze_sweep(std::span<const SweepEntry> entries, const FitOptions& options) {
  SweepAnalysis sweep;
  std::vector<Sliding> slidings;
  std::vector<SweepRecording> recordings;
  slidings.reserve(entries.size());
  for (const SweepEntry& entry : entries) {
    Sliding& sliding = slidings.emplace_back(find_sliding(entry.recording));
    const Recording& used = sliding.of(entry.recording);
    Fitted fitted = fit_signals(used, sliding.signals, {});
    sliding.signals = fitted.signals;
    sweep.recordings.push_back(judge_and_conclude(entry.recording, sliding, std::move(fitted)));
    // Slips that no model comes close to are none of a joint fit's either.
    const bool stranger = sweep.recordings.back().verdict == Verdict::StickSlip && !has_values(sweep.recordings.back());
    sweep.roles.push_back(stranger ? SweepRole::LeftOut : role_of(used, sweep.recordings.back().verdict));
    recordings.push_back({used, sliding.signals.quality, sliding.signals.segmentation, sweep.roles.back()});
  }
  sweep.joint = fit_sweep(recordings, options);
  if (sweep.joint) {
    sweep.joint->fit = in_range(std::move(sweep.joint->fit), {});
    for (SweepPoint& point : sweep.joint->points) point = in_range(std::move(point));
  }
  sweep.derived = in_range(derive_from_sweep(sweep.joint ? sweep.joint->fit : FitResult{}));
  sweep.joint_reason = describe_roles(sweep.roles);
  sweep.warnings = check_frequency_follows_speed(entries, sweep.recordings);
  if (sweep.joint) {
    const Warnings& of_fit = sweep.joint->fit.warnings;
    sweep.warnings.insert(sweep.warnings.end(), of_fit.begin(), of_fit.end());
  }
  return sweep;
}

}  // namespace slipfit
