#include "slipfit/pipeline.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analysis/classify.hpp"
#include "analysis/conclude.hpp"
#include "analysis/detect.hpp"
#include "analysis/estimate.hpp"
#include "analysis/ring_down.hpp"
#include "analysis/sweep_checks.hpp"
#include "core/parallel.hpp"
#include "slipfit/fit/sweep.hpp"
#include "slipfit/sweep.hpp"

// The method. detect() finds the stretch of a recording that slides and its slips; estimate() finds their frequency and
// fits the model to them; classify() says which kind of motion they are; conclude() works out all that follows. The
// recordings of a sweep take these steps each on its own; then fit_sweep() fits one set of parameters to all of them.

namespace slipfit {
namespace {

struct Steps {
  Detected detected;
  Estimates estimates;
  Analysis analysis;
};

Steps take_steps(const Recording& recording, const FitOptions& options) {
  Steps steps{detect(recording), {}, {}};
  FitOptions informed = options;
  informed.ring_down = ring_down_after_release(steps.detected);
  steps.estimates = estimate(steps.detected, informed);
  Classification classification = classify(steps.detected.recording(), steps.estimates);
  steps.analysis = conclude(steps.detected, steps.estimates, std::move(classification));
  return steps;
}

/// Returns what the fit of a sweep sees of a recording. It refers to `steps`.
SweepRecording seen_by_sweep(const Steps& steps, const Transients& transients, SweepRole role) {
  const Signals& signals = steps.estimates.signals;
  const std::optional<SteadyDrive>& drive = steps.estimates.drive;
  std::optional<RingDown> ring_down;
  if (transients.ring_down_frequency_Hz.value) {
    ring_down = RingDown{transients.ring_down_frequency_Hz, transients.ring_down_damping_ratio};
  }
  return {drive ? drive->recording : steps.detected.recording(), signals.quality, signals.segmentation, role,
          ring_down};
}

}  // namespace

Analysis analyze(const Recording& recording) {
  const Detected detected = detect(recording);
  Estimates estimates = estimate_frequency(detected);
  Classification classification = classify_by_shape(detected.recording(), estimates.signals);
  return without_falls(conclude(detected, estimates, std::move(classification)));
}

Analysis analyze_and_fit(const Recording& recording, const FitOptions& options) {
  Analysis analysis = without_falls(take_steps(recording, options).analysis);
  analysis.asked = AskedFit{options.tier, options.held};
  return analysis;
}

SweepAnalysis analyze_sweep(std::span<const SweepEntry> entries, const FitOptions& options) {
  SweepAnalysis sweep;
  FitOptions own;
  own.curve = options.curve;
  Notifier notify(options.notify_step);
  std::vector<Steps> steps = in_parallel(entries.size(), [&](std::size_t i) {
    notify("analysing recording " + std::to_string(i + 1) + " of " + std::to_string(entries.size()));
    return take_steps(entries[i].recording, own);
  });
  for (Steps& of_one : steps) {
    sweep.recordings.push_back(std::move(of_one.analysis));
    sweep.recordings.back().asked = AskedFit{};
  }
  sweep.asked = AskedFit{options.tier, options.held};
  sweep.roles = roles_of(entries, sweep.recordings);
  std::vector<SweepRecording> seen;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    seen.push_back(seen_by_sweep(steps[i], sweep.recordings[i].transients, sweep.roles[i]));
  }
  sweep.fit = fit_sweep(seen, options);
  return conclude_sweep(entries, std::move(sweep));
}

SweepAnalysis analyze_each(std::span<const SweepEntry> entries) {
  SweepAnalysis sweep;
  for (const SweepEntry& entry : entries) sweep.recordings.push_back(analyze(entry.recording));
  sweep.roles = roles_of(entries, sweep.recordings);
  sweep.fit_reason = "each recording was analysed on its own; slipfit fit fits them together";
  sweep.repeats = compare_repeats(entries, sweep.recordings);
  return sweep;
}

}  // namespace slipfit
