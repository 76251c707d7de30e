#include "fit/level/add_hum.hpp"

#include <complex>
#include <numbers>

namespace slipfit::fit {

namespace {

/// `use`: of a sample and the value of a line there, `factor` times; all lines one after the other.
template <class Use>
void for_each_wave(const Recording& recording, const BlockFit& fit, std::size_t begin, std::size_t end, double factor,
                   const Use& use) {
  if (begin >= end) return;
  const double step_s = recording.duration_s() / static_cast<double>(recording.size() - 1);
  const double since_s = recording.time_s()[begin] - fit.scales().time_begin_s;
  const double* pair = fit.wave_data();
  for (const double frequency_Hz : fit.level().lines_Hz) {
    const double omega = 2.0 * std::numbers::pi * frequency_Hz;
    const std::complex<double> turn = std::polar(1.0, omega * step_s);
    std::complex<double> wave =
        factor * fit.scales().force * std::complex(pair[0], -pair[1]) * std::polar(1.0, omega * since_s);
    for (std::size_t i = begin; i < end; ++i) {
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
  hum.force_beside.assign(force.begin(), force.end());
  for_each_wave(recording, fit, 0, force.size(), -1.0,
                [&](std::size_t i, double wave) { hum.force_beside[i] += wave; });
  return hum;
}

}  // namespace slipfit::fit
