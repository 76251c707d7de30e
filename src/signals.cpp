#include "signals.hpp"

#include <chrono>
#include <optional>
#include <utility>

#include "measured.hpp"
#include "verdict.hpp"

namespace slipfit {
namespace {

using Clock = std::chrono::steady_clock;

double elapsed_s(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

SpectrumLook look_at_spectrum(const Recording& recording, const Signals& signals,
                              const std::shared_future<void>& slips_found) {
  const auto start = Clock::now();
  const std::vector<bool>& impulses = signals.quality.impulse_mask;
  const Spectrum spectrum = compute_spectrum(recording, impulses);
  const double transform_s = elapsed_s(start);
  slips_found.get();
  const auto resumed = Clock::now();
  // A count that scatters may be of noise or hum: it would draw the spectrum to its own multiple.
  constexpr double kSureCount = 0.01;
  const Estimate counted = count_frequency(recording, signals.segmentation);
  const bool sure = slips_stand_out(signals.quality, signals.segmentation) && counted.standard_error &&
                    *counted.standard_error < kSureCount * *counted.value;
  const std::optional<double> hint_Hz = sure ? counted.value : std::nullopt;
  SpectralFrequency spectral = find_frequency(recording, spectrum, hint_Hz, impulses);
  return {std::move(spectral), transform_s + elapsed_s(resumed)};
}

SpectrumLook look_at_spectrum(const Recording& recording, const Signals& signals) {
  std::promise<void> slips_found;
  slips_found.set_value();
  return look_at_spectrum(recording, signals, slips_found.get_future());
}

Signals look_at(const Recording& recording) {
  const auto start = Clock::now();
  Signals signals;
  signals.quality = assess_quality(recording);
  signals.segmentation = find_slips(recording, signals.quality);
  signals.spectral = look_at_spectrum(recording, signals).spectral;
  signals.seconds = elapsed_s(start);
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
