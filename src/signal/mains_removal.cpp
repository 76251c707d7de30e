#include "signal/mains.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <span>
#include <utility>

#include "core/quantile.hpp"
#include "core/thresholds.hpp"
#include "signal/segments.hpp"
#include "signal/transform.hpp"
#include "signal/turns.hpp"

namespace slipfit::signal {
namespace {

/// Hann's, zero half a sample outside either end.
std::vector<double> window_of(std::size_t samples) {
  std::vector<double> window(samples);
  const double step = kTurn / static_cast<double>(samples);
  for_turns(samples, 0.5 * step, step, [&](std::size_t i, double cosine, double) { window[i] = 0.5 - 0.5 * cosine; });
  return window;
}

/// Complex amplitude of what turns by `step` from sample to sample, phase counted from the first one.
std::complex<double> amplitude_of(std::span<const double> values, const std::vector<double>& window, double mean,
                                  double step) {
  double real = 0.0;
  double imaginary = 0.0;
  for_turns(values.size(), 0.0, step, [&](std::size_t i, double cosine, double sine) {
    const double value = window[i] * (values[i] - mean);
    real += value * cosine;
    imaginary -= value * sine;
  });
  return 4.0 / static_cast<double>(values.size()) *
         std::complex(real, imaginary);  // Hann's window sums to half of them
}

/// Share of a line's energy that the quarter of the recording with most of it holds. Parts of so few periods that the
/// mains keeps its phase in each of them.
double largest_quarter(const UniformTrace& trace, double frequency_Hz) {
  constexpr std::size_t kQuarters = 4;
  constexpr double kPeriods = 250.0;  // the mains keeps its frequency to 0.1 %
  const auto samples = static_cast<double>(trace.force.size());
  const double periods = frequency_Hz * trace.step_s * samples;
  const auto in_quarter = static_cast<std::size_t>(std::ceil(periods / (kPeriods * kQuarters)));
  const std::size_t length = trace.force.size() / (kQuarters * in_quarter);
  const std::vector<double> window = window_of(length);
  double largest = 0.0;
  double all = 0.0;
  for (std::size_t quarter = 0; quarter < kQuarters; ++quarter) {
    double energy = 0.0;
    for (std::size_t i = 0; i < in_quarter; ++i) {
      const auto part = std::span(trace.force).subspan((quarter * in_quarter + i) * length, length);
      energy += std::norm(amplitude_of(part, window, mean_of(part), kTurn * frequency_Hz * trace.step_s));
    }
    largest = std::max(largest, energy);
    all += energy;
  }
  return all > 0.0 ? largest / all : 0.0;
}

}  // namespace

std::vector<MainsLine> without_bursts(std::vector<MainsLine> lines, const UniformTrace& trace) {
  constexpr double kFewestPeriods = 16.0;  // four in a quarter: its window has to resolve them
  std::erase_if(lines, [&](const MainsLine& line) {
    const double periods = line.frequency_Hz * trace.step_s * static_cast<double>(trace.force.size());
    return periods >= kFewestPeriods && largest_quarter(trace, line.frequency_Hz) > thresholds::kBurst;
  });
  return lines;
}

Dehummed without_mains(const Recording& recording) {
  const auto time_s = recording.time_s();
  const UniformTrace even = resample(recording, {});
  const std::size_t length = good_length(even.force.size());
  const std::vector<double> power = hann_power(even.force, length);
  const double mean = mean_of(even.force);
  const std::vector<double> window = window_of(even.force.size());
  Dehummed result;
  result.force.assign(recording.force().begin(), recording.force().end());
  const double bin_Hz = 1.0 / (static_cast<double>(length) * even.step_s);
  for (const MainsLine& line : without_bursts(find_mains(power, bin_Hz, 1.0 / recording.duration_s()), even)) {
    const double omega = kTurn * line.frequency_Hz;
    const std::complex<double> amplitude = amplitude_of(even.force, window, mean, omega * even.step_s);
    const double size = std::abs(amplitude);
    if (recording.clock_is_even()) {
      for_turns(recording.size(), std::arg(amplitude), omega * even.step_s,
                [&](std::size_t i, double cosine, double) { result.force[i] -= size * cosine; });
    } else {
      for (std::size_t i = 0; i < time_s.size(); ++i) {
        result.force[i] -= size * std::cos(std::arg(amplitude) + omega * (time_s[i] - time_s.front()));
      }
    }
    result.lines_Hz.push_back(line.frequency_Hz);
    result.swing = std::max(result.swing, 2.0 * size);
  }
  return result;
}

}  // namespace slipfit::signal
