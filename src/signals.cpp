#include "signals.hpp"

#include <chrono>
#include <optional>
#include <utility>

#include "slip_counts.hpp"
#include "verdict.hpp"

namespace slipfit {
namespace {

using Clock = std::chrono::steady_clock;

double elapsed_s(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

Sliding find_sliding(const Recording& recording) {
  const auto start = Clock::now();
  Sliding sliding;
  Signals& signals = sliding.signals;
  signals.quality = assess_quality(recording);
  signals.segmentation = find_slips(recording, signals.quality);
  sliding.whole_quality = signals.quality;
  const Segmentation& seen = signals.segmentation;
  const bool whole = seen.sliding_begin == 0 && seen.sliding_end == recording.size();
  if (!whole && !recording.provenance().window_given) {
    Recording part = recording.part(seen.sliding_begin, seen.sliding_end);
    Quality quality = assess_quality(part);
    Segmentation slips = find_slips(part, quality);
    // A ring-down is told by what comes after it, waves and noise by the whole.
    if (slips_are_sudden(slips)) {
      sliding.begin = seen.sliding_begin;
      sliding.part = std::move(part);
      signals.quality = std::move(quality);
      signals.segmentation = std::move(slips);
    }
  }
  signals.seconds = elapsed_s(start);
  return sliding;
}

SpectrumLook look_at_spectrum(const Recording& recording, const Signals& signals) {
  const auto start = Clock::now();
  const std::vector<bool>& impulses = signals.quality.impulse_mask;
  const Spectrum spectrum = compute_spectrum(recording, impulses);
  // A count that scatters may be of noise or hum: it would draw the spectrum to its own multiple.
  constexpr double kSureCount = 0.01;
  const Estimate counted = count_frequency(recording, signals.segmentation);
  const bool sure = slips_stand_out(signals.segmentation) && counted.standard_error &&
                    *counted.standard_error < kSureCount * *counted.value;
  const std::optional<double> hint_Hz = sure ? counted.value : std::nullopt;
  SpectralFrequency spectral = find_frequency(recording, spectrum, hint_Hz, impulses);
  return {std::move(spectral), elapsed_s(start)};
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
