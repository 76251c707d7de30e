#include "analysis/estimate.hpp"

#include <algorithm>
#include <cstddef>
#include <future>
#include <limits>
#include <utility>
#include <vector>

#include "analysis/ranges.hpp"
#include "analysis/slip_intervals.hpp"
#include "analysis/slip_shape.hpp"
#include "core/parallel.hpp"
#include "core/thresholds.hpp"

namespace slipfit {
namespace {

struct TimedFrequency {
  SpectralFrequency spectral;
  double seconds = 0.0;
};

TimedFrequency frequency_of(const Recording& recording, const Signals& signals) {
  const Stopwatch stopwatch;
  const std::vector<bool>& impulses = signals.quality.impulse_mask;
  const Spectrum spectrum = compute_spectrum(recording, impulses);
  // A count that scatters may be of noise or hum: it would draw the spectrum to its own multiple.
  const Estimate counted = count_frequency(recording, signals.segmentation);
  const bool sure = slips_stand_out(signals.segmentation) && counted.standard_error &&
                    *counted.standard_error < thresholds::kSureCount * *counted.value;
  const std::optional<double> hint_Hz = sure ? counted.value : std::nullopt;
  SpectralFrequency spectral = find_frequency(recording, spectrum, hint_Hz, impulses);
  return {std::move(spectral), stopwatch.elapsed_s()};
}

/// How badly the cycles fit: residual and spread over the onset force. A missing fit is the worst; so is one that finds
/// cycles in less than half of the slips offered to it, which are then no slips: a rhythm near the mains that was taken
/// out as hum leaves such remains behind.
double misfit_of(const std::optional<FitResult>& fit) {
  if (!fit) return std::numeric_limits<double>::infinity();
  const std::vector<Cycle>& cycles = fit->cycles;
  const auto used = std::ranges::count_if(cycles, [](const Cycle& cycle) { return cycle.used; });
  const auto offered = std::ranges::count_if(cycles, [](const Cycle& cycle) { return cycle.selected; });
  if (2 * used < offered) return std::numeric_limits<double>::infinity();
  return fit->diagnostics.relative_residual + 0.3 * fit->diagnostics.onset_force_spread;
}

/// Lines of the mains in the level take up some noise by themselves: a fit beneath them has to be clearly better.
Estimates without_mains_if_better(const Recording& recording, const FitOptions& options, Estimates seen) {
  std::optional<Segmentation> beneath =
      find_slips_beneath_hum(recording, seen.signals.quality, seen.signals.segmentation);
  if (!beneath) return seen;
  std::optional<FitResult> other = fit_recording(recording, seen.signals.quality, *beneath, options);
  if (!(misfit_of(other) < thresholds::kClearlyBetter * misfit_of(seen.fit))) return seen;
  seen.signals.segmentation = std::move(*beneath);
  seen.signals.spectral = frequency_of(recording, seen.signals).spectral;
  seen.fit = std::move(other);
  return seen;
}

}  // namespace

Estimates estimate_frequency(const Detected& detected) {
  Estimates estimates{detected.signals, {}};
  TimedFrequency timed = frequency_of(detected.recording(), estimates.signals);
  estimates.signals.spectral = std::move(timed.spectral);
  estimates.frequency_s = timed.seconds;
  return estimates;
}

Estimates estimate(const Detected& detected, const FitOptions& options) {
  constexpr std::size_t kLarge = 1000000;  // samples: the arrays of spectrum and fit together would be large
  const Recording& recording = detected.recording();
  Estimates estimates{detected.signals, {}};
  // Named, and so copied: where there is no thread, async begins anew with what it was given.
  const auto spectrum_task = [&] { return frequency_of(recording, detected.signals); };
  std::future<TimedFrequency> frequency = std::async(kLaunch, spectrum_task);
  if (recording.size() >= kLarge) frequency.wait();
  const Stopwatch stopwatch;
  estimates.fit = fit_recording(recording, estimates.signals.quality, estimates.signals.segmentation, options);
  TimedFrequency timed = frequency.get();
  estimates.signals.spectral = std::move(timed.spectral);
  estimates.frequency_s = timed.seconds;
  if (may_be_hum(estimates.signals)) estimates = without_mains_if_better(recording, options, std::move(estimates));
  if (estimates.fit) estimates.fit = in_range(*std::move(estimates.fit), recording.conditions());
  estimates.fit_s = stopwatch.elapsed_s();
  return estimates;
}

bool may_be_hum(const Signals& signals) {
  const double drop = median_drop(signals.segmentation);
  for (const SuspiciousLine& line : signals.spectral.suspicious_lines) {
    if (line.swing >= kHarmlessHum * drop) return true;
  }
  const double share = mains_share(signals.segmentation);
  return share > 0.9 && share < 1.1;
}

}  // namespace slipfit
