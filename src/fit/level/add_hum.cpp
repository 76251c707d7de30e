#include "fit/level/add_hum.hpp"

#include <complex>
#include <numbers>

namespace slipfit::fit {

void add_hum(const Recording& recording, const BlockFit& fit, std::size_t begin, std::size_t end, double factor,
             std::vector<double>& values) {
  if (begin >= end) return;
  const double step_s = recording.duration_s() / static_cast<double>(recording.size() - 1);
  const double since_s = recording.time_s()[begin] - fit.scales().time_begin_s;
  const double* pair = fit.parameters.level.data() + fit.level().first_line();
  for (const double frequency_Hz : fit.level().lines_Hz) {
    const double omega = 2.0 * std::numbers::pi * frequency_Hz;
    const std::complex<double> turn = std::polar(1.0, omega * step_s);
    std::complex<double> wave =
        factor * fit.scales().force * std::complex(pair[0], -pair[1]) * std::polar(1.0, omega * since_s);
    for (std::size_t i = begin; i < end; ++i) {
      if (values[i] != 0.0) values[i] += wave.real();
      wave *= turn;
    }
    pair += 2;
  }
}

}  // namespace slipfit::fit
