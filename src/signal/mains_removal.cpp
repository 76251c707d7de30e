#include "signal/mains.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "signal/segments.hpp"
#include "signal/transform.hpp"

namespace slipfit::signal {
namespace {

/// Complex amplitude of one frequency, phase counted from the first sample.
std::complex<double> amplitude_of(const std::vector<double>& values, double mean, double step_s, double frequency_Hz) {
  std::complex<double> sum = 0.0;
  double weights = 0.0;
  // Turned from sample to sample: after 10^7 of them the phase is still good to 1e-9.
  const auto count = static_cast<double>(values.size());
  const std::complex<double> turn = std::polar(1.0, -kTurn * frequency_Hz * step_s);
  const std::complex<double> window_turn = std::polar(1.0, kTurn / count);
  std::complex<double> wave = 1.0;
  std::complex<double> window = std::polar(1.0, 0.5 * kTurn / count);
  for (const double value : values) {
    const double weight = 0.5 - 0.5 * window.real();
    sum += weight * (value - mean) * wave;
    weights += weight;
    wave *= turn;
    window *= window_turn;
  }
  return 2.0 * sum / weights;
}

}  // namespace

Dehummed without_mains(const Recording& recording) {
  Dehummed result;
  result.force.assign(recording.force().begin(), recording.force().end());
  if (!recording.clock_is_even()) return result;
  const double step_s = recording.duration_s() / static_cast<double>(recording.size() - 1);
  const std::size_t length = good_length(recording.size());
  const std::vector<double> power = hann_power(result.force, length);
  double mean = 0.0;
  for (const double f : result.force) mean += f / static_cast<double>(recording.size());
  for (const MainsLine& line :
       find_mains(power, 1.0 / (static_cast<double>(length) * step_s), 1.0 / recording.duration_s())) {
    const std::complex<double> amplitude = amplitude_of(result.force, mean, step_s, line.frequency_Hz);
    const std::complex<double> turn = std::polar(1.0, kTurn * line.frequency_Hz * step_s);
    std::complex<double> wave = amplitude;
    for (double& force : result.force) {
      force -= wave.real();
      wave *= turn;
    }
    result.lines_Hz.push_back(line.frequency_Hz);
    result.swing = std::max(result.swing, 2.0 * std::abs(amplitude));
  }
  return result;
}

}  // namespace slipfit::signal
