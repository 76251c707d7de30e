#include "signal/mains.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <span>
#include <utility>

#include "core/statistics.hpp"
#include "core/thresholds.hpp"
#include "signal/phase_track.hpp"
#include "signal/smoothing.hpp"
#include "signal/transform.hpp"

namespace slipfit::signal {

namespace {

constexpr std::array kMains_Hz{50.0, 60.0};
constexpr int kMostHarmonics = 20;

/// Half of the width that a line takes, which wanders with the mains.
double half_width(double resolution_Hz, double line_Hz) {
  return std::max(3.0 * resolution_Hz, 2e-3 * line_Hz);
}

/// The median power on both sides of the line, over 16 resolutions.
double background_level(std::span<const double> power, double bin_Hz, double resolution_Hz, double line_Hz) {
  std::vector<double> beside;
  const double top = static_cast<double>(power.size()) - 1.0;
  const auto collect = [&](double low_Hz, double high_Hz) {
    const double low = std::clamp(std::ceil(low_Hz / bin_Hz), 1.0, top);
    const double high = std::clamp(std::floor(high_Hz / bin_Hz), 1.0, top);
    for (double i = low; i <= high; i += 1.0) beside.push_back(power[static_cast<std::size_t>(i)]);
  };
  const double near = half_width(resolution_Hz, line_Hz);
  const double far = near + 16.0 * resolution_Hz;
  collect(line_Hz - far, line_Hz - near);
  collect(line_Hz + near, line_Hz + far);
  return median(std::move(beside));
}

constexpr double kWander = 1e-3;  // the mains keeps its frequency to 0.1 %

/// The top of a peak is known to a fraction of the resolution.
double tolerance_of(double resolution_Hz, double target_Hz) {
  return std::max(0.3 * resolution_Hz, kWander * target_Hz);
}

bool is_at(double frequency_Hz, double target_Hz, double resolution_Hz) {
  return std::abs(frequency_Hz - target_Hz) <= tolerance_of(resolution_Hz, target_Hz);
}

/// The ratio of power to the median around it that makes a line: four times in amplitude, more where so many bins are
/// looked at that noise alone would reach it (one recording in a thousand; the median of noise power is ln 2 of its
/// mean).
double prominence_among(double bins) {
  return std::max(16.0, std::log(1e3 * bins) / std::log(2.0));
}

/// Returns that ratio for the frequencies where the mains may be.
double prominence(double bins) {
  return prominence_among(4.0 * kMostHarmonics * bins);
}

/// Top of the parabola through the logarithms of a bin and its neighbours, in bins from it.
double peak_offset(double before, double here, double after) {
  if (!(before > 0.0 && after > 0.0)) return 0.0;
  const double rise = std::log(here / before);
  const double fall = std::log(here / after);
  return rise + fall > 0.0 ? 0.5 * (rise - fall) / (rise + fall) : 0.0;
}

std::optional<MainsLine> line_at(std::span<const double> power, double bin_Hz, double resolution_Hz, double target_Hz) {
  const double tolerance = tolerance_of(resolution_Hz, target_Hz);
  const auto low = static_cast<std::size_t>(std::floor((target_Hz - tolerance) / bin_Hz));
  const auto high = static_cast<std::size_t>(std::ceil((target_Hz + tolerance) / bin_Hz));
  if (low < 1 || high + 1 >= power.size()) return std::nullopt;
  const auto first = power.begin() + static_cast<std::ptrdiff_t>(low);
  const auto last = power.begin() + static_cast<std::ptrdiff_t>(high) + 1;
  const auto peak = static_cast<std::size_t>(std::max_element(first, last) - power.begin());
  if (power[peak] < power[peak - 1] || power[peak] < power[peak + 1]) return std::nullopt;
  const double offset = peak_offset(power[peak - 1], power[peak], power[peak + 1]);
  const double frequency = (static_cast<double>(peak) + offset) * bin_Hz;
  if (std::abs(frequency - target_Hz) > tolerance) return std::nullopt;
  const double background = background_level(power, bin_Hz, resolution_Hz, frequency);
  if (power[peak] <= prominence(tolerance / resolution_Hz) * background) return std::nullopt;
  // The further the peak stands out, the better its frequency is known.
  constexpr double kInterpolation = 0.05;  // of the resolution: error of the parabola on a peak of Hann's window
  const double error_Hz = (kInterpolation + std::sqrt(background / power[peak])) * resolution_Hz;
  return MainsLine{frequency, 0.0, 1, half_width(resolution_Hz, frequency), error_Hz};
}

}  // namespace

std::vector<MainsLine> find_mains(std::span<const double> power, double bin_Hz, double resolution_Hz,
                                  std::span<const double> known_Hz) {
  const double highest_Hz = bin_Hz * (static_cast<double>(power.size()) - 2.0);
  std::vector<MainsLine> best;
  double best_power = 0.0;
  for (const double mains_Hz : kMains_Hz) {
    std::vector<MainsLine> lines;
    double total = 0.0;
    bool has_lower = false;
    for (int order = 1; order <= kMostHarmonics && mains_Hz * order < highest_Hz; ++order) {
      const double target_Hz = mains_Hz * order;
      if (target_Hz < 4.0 * resolution_Hz) continue;
      has_lower = has_lower ||
                  std::ranges::any_of(known_Hz, [&](double known) { return is_at(known, target_Hz, resolution_Hz); });
      std::optional<MainsLine> line = line_at(power, bin_Hz, resolution_Hz, target_Hz);
      if (!line) continue;
      // Above the third a harmonic of the mains counts only where a lower one was found: mains has those, and a single
      // line at such a place is of something else.
      if (order > 3 && !has_lower) continue;
      has_lower = true;
      line->mains_Hz = mains_Hz;
      line->order = order;
      lines.push_back(*line);
      total += power[static_cast<std::size_t>(std::lround(line->frequency_Hz / bin_Hz))];
    }
    if (total > best_power) {
      best = std::move(lines);
      best_power = total;
    }
  }
  return best;
}

std::optional<double> strongest_line(std::span<const double> power, double bin_Hz, double resolution_Hz,
                                     double lowest_Hz) {
  const auto lowest = static_cast<std::size_t>(std::max(1.0, std::ceil(lowest_Hz / bin_Hz)));
  if (lowest + 2 >= power.size()) return std::nullopt;
  const auto first = power.begin() + static_cast<std::ptrdiff_t>(lowest);
  const auto peak = static_cast<std::size_t>(std::max_element(first, power.end() - 1) - power.begin());
  const double offset = peak_offset(power[peak - 1], power[peak], power[peak + 1]);
  const double frequency_Hz = (static_cast<double>(peak) + offset) * bin_Hz;
  const double beside = background_level(power, bin_Hz, resolution_Hz, frequency_Hz);
  if (power[peak] <= prominence_among(static_cast<double>(power.size())) * beside) return std::nullopt;
  return frequency_Hz;
}

std::optional<double> mains_in_step(double frequency_Hz, int harmonics, double duration_s) {
  constexpr double kTurns = 1.5;
  for (const double mains_Hz : kMains_Hz) {
    for (int order = 1; order <= harmonics; ++order) {
      if (std::abs(order * frequency_Hz - mains_Hz) * duration_s < kTurns) return mains_Hz;
    }
  }
  return std::nullopt;
}

bool is_of_mains(double frequency_Hz, double resolution_Hz) {
  return std::ranges::any_of(kMains_Hz, [&](double mains_Hz) {
    const double order = std::max(1.0, std::round(frequency_Hz / mains_Hz));
    return std::abs(frequency_Hz - order * mains_Hz) < std::max(resolution_Hz, 2e-3 * frequency_Hz);
  });
}

std::string describe(const MainsLine& line) {
  if (line.order == 1) return fmt::format("mains {:.0f} Hz", line.mains_Hz);
  constexpr std::array kEndings{"th", "st", "nd", "rd"};
  const bool teen = line.order >= 10 && line.order < 20;
  const int digit = line.order % 10;
  const char* ending = kEndings.at(!teen && digit <= 3 ? static_cast<std::size_t>(digit) : 0);
  return fmt::format("{}{} harmonic of {:.0f} Hz mains", line.order, ending, line.mains_Hz);
}

void flatten(std::vector<double>& power, double bin_Hz, double resolution_Hz, const MainsLine& line) {
  const double level = background_level(power, bin_Hz, resolution_Hz, line.frequency_Hz);
  const double top = static_cast<double>(power.size()) - 1.0;
  const double low = std::clamp(std::ceil((line.frequency_Hz - line.width_Hz) / bin_Hz), 0.0, top);
  const double high = std::clamp(std::floor((line.frequency_Hz + line.width_Hz) / bin_Hz), 0.0, top);
  for (double i = low; i <= high; i += 1.0) {
    double& bin = power[static_cast<std::size_t>(i)];
    bin = std::min(bin, level);
  }
}

std::vector<MainsLine> without_hinted(std::vector<MainsLine> lines, std::optional<double> hint_Hz) {
  double agreeing_Hz = 0.0;
  for (const MainsLine& line : lines) {
    if (hint_Hz && std::abs(*hint_Hz / line.frequency_Hz - 1.0) < 0.03) agreeing_Hz = line.mains_Hz;
  }
  std::erase_if(lines, [&](const MainsLine& line) { return line.mains_Hz == agreeing_Hz; });
  return lines;
}

bool is_on_line(const std::vector<MainsLine>& lines, double frequency_Hz, double reach_Hz) {
  return std::ranges::any_of(lines, [&](const MainsLine& line) {
    return std::abs(line.frequency_Hz - frequency_Hz) < std::max(line.width_Hz, reach_Hz);
  });
}

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
  constexpr double kPeriods = 0.25 / kWander;
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

std::vector<MainsLine> lasting_mains(std::vector<MainsLine> lines, const UniformTrace& trace) {
  constexpr double kFewestPeriods = 16.0;  // four in a quarter: its window has to resolve them
  std::erase_if(lines, [&](const MainsLine& line) {
    const double mains_Hz = line.mains_Hz * line.order;
    if (std::abs(line.frequency_Hz - mains_Hz) > std::max(line.error_Hz, kWander * mains_Hz)) return true;
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
  for (const MainsLine& line : lasting_mains(find_mains(power, bin_Hz, 1.0 / recording.duration_s()), even)) {
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
