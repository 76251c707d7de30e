#include "signals.hpp"

#include <chrono>
#include <optional>
#include <utility>

#include "measured.hpp"
#include "verdict.hpp"

namespace slipfit {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

Signals look_at_slips(const Recording& recording) {
  const auto start = Clock::now();
  Signals signals;
  signals.quality = assess_quality(recording);
  signals.segmentation = find_slips(recording, signals.quality);
  signals.seconds = seconds_since(start);
  return signals;
}

SpectrumLook look_at_spectrum(const Recording& recording, const Quality& quality, const Segmentation& segmentation) {
  const auto start = Clock::now();
  // A count that scatters may be of noise or hum: it would draw the spectrum to its own multiple.
  constexpr double kSureCount = 0.01;
  const Estimate counted = count_frequency(recording, segmentation);
  const bool sure = slips_stand_out(quality, segmentation) && counted.standard_error &&
                    *counted.standard_error < kSureCount * *counted.value;
  const std::optional<double> hint_Hz = sure ? counted.value : std::nullopt;
  const std::vector<bool>& impulses = quality.impulse_mask;
  SpectralFrequency spectral = find_frequency(recording, compute_spectrum(recording, impulses), hint_Hz, impulses);
  return {std::move(spectral), seconds_since(start)};
}

void add_spectrum(Signals& signals, SpectrumLook look) {
  signals.spectral = std::move(look.spectral);
  signals.seconds += look.seconds;
}

Signals look_at(const Recording& recording) {
  Signals signals = look_at_slips(recording);
  add_spectrum(signals, look_at_spectrum(recording, signals.quality, signals.segmentation));
  return signals;
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
