#include "fit/level/add_hum.hpp"

#include <complex>
#include <numbers>

namespace slipfit::fit {

namespace {

/// Calls `use` with each sample and `factor` times the value of a line there, for one line after the other.
template <class Use>
void for_each_wave(const Recording& recording, const BlockFit& fit, std::size_t begin, std::size_t end, double factor,
                   const Use& use) {
  if (begin >= end) return;
  const auto time_s = recording.time_s();
  const bool is_even = recording.clock_is_even();
  const double step_s = recording.duration_s() / static_cast<double>(recording.size() - 1);
  const double* pair = fit.wave_data();
  for (const double frequency_Hz : fit.level().lines_Hz) {
    const double omega = 2.0 * std::numbers::pi * frequency_Hz;
    const std::complex<double> amplitude = factor * fit.scales().force * std::complex(pair[0], -pair[1]);
    const std::complex<double> turn = std::polar(1.0, omega * step_s);
    std::complex<double> wave;
    for (std::size_t i = begin; i < end; ++i) {
      const bool is_anew = i == begin || !is_even;
      if (is_anew) wave = amplitude * std::polar(1.0, omega * (time_s[i] - fit.scales().time_begin_s));
      use(i, wave.real());
      wave *= turn;
    }
    pair += 2;
  }
}

}  // namespace

void add_hum(const Recording& recording, const BlockFit& fit, std::size_t begin, std::size_t end, double factor,
             std::vector<double>& values) {
  for_each_wave(recording, fit, begin, end, factor, [&](std::size_t i, double wave) {
    if (values[i] != 0.0) values[i] += wave;
  });
}

HumLines hum_of(const Recording& recording, const BlockFit& fit) {
  HumLines hum{fit.level().lines_Hz, fit.scales().time_begin_s};
  if (hum.frequencies_Hz.empty()) return hum;
  const auto force = recording.force();
  hum.force_without_lines.assign(force.begin(), force.end());
  for_each_wave(recording, fit, 0, force.size(), -1.0,
                [&](std::size_t i, double wave) { hum.force_without_lines[i] += wave; });
  return hum;
}

}  // namespace slipfit::fit
