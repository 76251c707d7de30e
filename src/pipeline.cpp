#include "slipfit/pipeline.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <future>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "fit/cycle/cycle_table.hpp"
#include "fit/selection/qualify.hpp"
#include "measured.hpp"
#include "ranges.hpp"
#include "recording_checks.hpp"
#include "signals.hpp"
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
  analysis.frequency = in_range(report_frequency(recording, signals, judgement.verdict, fit ? &*fit : nullptr));
  analysis.cycles = in_range(summarise_cycles(recording, signals.segmentation, fit ? &*fit : nullptr));
  analysis.cycle_table = fit ? fit->cycles : fit::detected_cycles(recording, signals.segmentation);
  if (fit && analysis.verdict != Verdict::StickSlip) fit = fit::without_parameters(*std::move(fit));
  if (fit && analysis.frequency.quoted.value) {
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

/// The spectrum is computed beside the search for slips and judged beside the fit, in a thread where one is to be had.
Fitted look_and_fit(const Recording& recording, const FitOptions& options) {
  constexpr std::size_t kLarge = 1000000;  // the arrays of spectrum and fit together would be large
  const auto start = Clock::now();
  Fitted fitted;
  Signals& signals = fitted.signals;
  signals.quality = assess_quality(recording);
  std::future<SpectrumLook> look;  // waits for the thread when it goes,
  std::promise<void> slips_found;  // so the promise that the thread waits for goes first
  // Named, and so copied: where there is no thread, async begins anew with what it was given.
  const auto look_meanwhile = [&, found = slips_found.get_future().share()] {
    return look_at_spectrum(recording, signals, found);
  };
  look = std::async(look_meanwhile);
  signals.segmentation = find_slips(recording, signals.quality);
  slips_found.set_value();
  signals.seconds = seconds_since(start);
  if (recording.size() >= kLarge) look.wait();
  const auto fit_start = Clock::now();
  fitted.fit = fit_recording(recording, signals.quality, signals.segmentation, options);
  SpectrumLook looked = look.get();
  signals.spectral = std::move(looked.spectral);
  signals.seconds += looked.seconds;
  if (may_be_hum(signals)) look_beneath_hum(recording, options, fitted);
  fitted.seconds = seconds_since(fit_start);
  return fitted;
}

Analysis judge_and_conclude(const Recording& recording, Fitted fitted) {
  const Signals& signals = fitted.signals;
  Judgement judgement = judge_fit(recording, signals.quality, signals.segmentation, signals.spectral,
                                  fitted.fit ? &*fitted.fit : nullptr);
  Analysis analysis = conclude(recording, std::move(fitted.signals), std::move(judgement), std::move(fitted.fit));
  analysis.timing.fit_s = fitted.seconds;
  return analysis;
}

}  // namespace

Analysis analyze(const Recording& recording) {
  Signals signals = look_at(recording);
  Judgement judgement = judge_shape(recording, signals.quality, signals.segmentation, signals.spectral);
  return conclude(recording, std::move(signals), std::move(judgement), std::nullopt);
}

Analysis analyze_and_fit(const Recording& recording, const FitOptions& options) {
  return judge_and_conclude(recording, look_and_fit(recording, options));
}

SweepAnalysis analyze_sweep(std::span<const SweepEntry> entries, const FitOptions& options) {
  SweepAnalysis sweep;
  std::vector<Signals> signals;
  std::vector<SweepRecording> recordings;
  signals.reserve(entries.size());
  for (const SweepEntry& entry : entries) {
    Fitted fitted = look_and_fit(entry.recording, {});
    signals.push_back(fitted.signals);
    sweep.recordings.push_back(judge_and_conclude(entry.recording, std::move(fitted)));
    sweep.roles.push_back(role_of(entry.recording, sweep.recordings.back().verdict));
    recordings.push_back({entry.recording, signals.back().quality, signals.back().segmentation, sweep.roles.back()});
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
