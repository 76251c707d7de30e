#include "slipfit/pipeline.hpp"

#include <chrono>

#include "measured.hpp"
#include "slipfit/sweep.hpp"
#include "sweep_checks.hpp"
#include "verdict.hpp"

namespace slipfit {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// What both entries share: quality, slips and the repetition frequency.
struct Signals {
  Quality quality;
  Segmentation segmentation;
  SpectralFrequency spectral;
  double seconds = 0.0;
};

Signals look_at(const Recording& recording) {
  const auto start = Clock::now();
  Signals signals;
  signals.quality = assess_quality(recording);
  signals.segmentation = find_slips(recording, signals.quality);
  const std::vector<bool>& impulses = signals.quality.impulse_mask;
  // A count that scatters may be of noise or hum: it would draw the spectrum to its own multiple.
  constexpr double kSureCount = 0.01;
  const Estimate counted = count_frequency(recording, signals.segmentation);
  const bool sure = slips_stand_out(signals.quality, signals.segmentation) && counted.standard_error &&
                    *counted.standard_error < kSureCount * *counted.value;
  const std::optional<double> hint_Hz = sure ? counted.value : std::nullopt;
  signals.spectral = find_frequency(recording, compute_spectrum(recording, impulses), hint_Hz, impulses);
  signals.seconds = seconds_since(start);
  return signals;
}

Analysis conclude(const Recording& recording, Signals signals, Judgement judgement, std::optional<FitResult> fit) {
  Analysis analysis;
  analysis.verdict = judgement.verdict;
  analysis.verdict_reason = judgement.reason;
  analysis.frequency =
      report_frequency(recording, signals.segmentation, signals.spectral, judgement.verdict, fit ? &*fit : nullptr);
  analysis.cycles = summarise_cycles(recording, signals.segmentation, fit ? &*fit : nullptr);
  analysis.cycle_table = fit ? fit->cycles : table_of(recording, signals.segmentation);
  if (fit && analysis.verdict != Verdict::StickSlip) withdraw_parameters(*fit);
  if (fit) analysis.derived = derive_from_model(*fit, recording.conditions());
  if (!fit && recording.conditions().measured_spacing_m) {
    analysis.derived.measured_spacing_En = Estimate{{}, {}, {}, "needs a fitted model"};
  }
  add_measured_spacing(recording, analysis.frequency, analysis.cycles, analysis.derived);
  analysis.quality = std::move(signals.quality);
  analysis.fit = std::move(fit);
  analysis.warnings = collect_warnings(recording, analysis);
  analysis.timing.frequency_s = signals.seconds;
  return analysis;
}

SweepRole role_of(Verdict verdict) {
  if (verdict == Verdict::StickSlip) return SweepRole::Cycles;
  return verdict == Verdict::SteadySliding ? SweepRole::Steady : SweepRole::LeftOut;
}

}  // namespace

Analysis analyze(const Recording& recording) {
  Signals signals = look_at(recording);
  Judgement judgement = judge_shape(recording, signals.quality, signals.segmentation, signals.spectral);
  return conclude(recording, std::move(signals), std::move(judgement), std::nullopt);
}

Analysis analyze_and_fit(const Recording& recording, const FitOptions& options) {
  Signals signals = look_at(recording);
  const auto start = Clock::now();
  std::optional<FitResult> fit = fit_recording(recording, signals.quality, signals.segmentation, options);
  const double fit_s = seconds_since(start);
  Judgement judgement =
      judge_fit(recording, signals.quality, signals.segmentation, signals.spectral, fit ? &*fit : nullptr);
  Analysis analysis = conclude(recording, std::move(signals), std::move(judgement), std::move(fit));
  analysis.timing.fit_s = fit_s;
  return analysis;
}

SweepAnalysis analyze_sweep(std::span<const SweepEntry> entries, const FitOptions& options) {
  SweepAnalysis sweep;
  std::vector<Signals> signals;
  std::vector<SweepRecording> recordings;
  signals.reserve(entries.size());
  for (const SweepEntry& entry : entries) {
    sweep.recordings.push_back(analyze_and_fit(entry.recording, {}));
    sweep.roles.push_back(role_of(sweep.recordings.back().verdict));
    signals.push_back(look_at(entry.recording));
    recordings.push_back({entry.recording, signals.back().quality, signals.back().segmentation, sweep.roles.back()});
  }
  sweep.joint = fit_jointly(recordings, options);
  sweep.joint_reason = describe_roles(sweep.roles);
  sweep.warnings = check_frequency_follows_speed(entries, sweep.recordings);
  return sweep;
}

}  // namespace slipfit
