#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <optional>
#include <string>

#include "slipfit/signal/quality.hpp"
#include "slipfit/signal/spectrum.hpp"
#include "traces.hpp"

namespace traces {

using slipfit::Recording;
using slipfit::SpectralFrequency;

inline SpectralFrequency find(const Recording& recording, std::optional<double> hint_Hz = std::nullopt) {
  return slipfit::find_frequency(recording, slipfit::compute_spectrum(recording), hint_Hz);
}

/// As the pipeline does it: impulses held.
inline SpectralFrequency find_held(const Recording& recording, std::optional<double> hint_Hz = std::nullopt) {
  const slipfit::Quality quality = slipfit::assess_quality(recording);
  return slipfit::find_frequency(recording, slipfit::compute_spectrum(recording, quality.impulse_mask), hint_Hz,
                                 quality.impulse_mask);
}

inline Recording noisy_saw_tooth(const SawTooth& shape, std::size_t samples, double noise, std::uint64_t seed) {
  Generator generator(seed);
  const std::vector<double> time_s = clock(samples, 1000.0);
  std::vector<double> force = saw_tooth(shape, time_s, generator);
  add_noise(force, noise, generator);
  return recording(time_s, force);
}

inline void check_frequency(const SpectralFrequency& found, double expected_Hz, double epsilon) {
  REQUIRE(found.value_Hz);
  CHECK(*found.value_Hz == Approx(expected_Hz).epsilon(epsilon));
}

inline bool names_line(const SpectralFrequency& found, double frequency_Hz, const std::string& reason) {
  return std::any_of(found.suspicious_lines.begin(), found.suspicious_lines.end(),
                     [&](const slipfit::SuspiciousLine& line) {
                       return std::abs(line.frequency_Hz - frequency_Hz) < 1e-3 * frequency_Hz && line.reason == reason;
                     });
}

}  // namespace traces
