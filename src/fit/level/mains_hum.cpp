#include "fit/level/mains_hum.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/fit_thresholds.hpp"
#include "fit/level/stick_ripple.hpp"
#include "signal/mains.hpp"

namespace slipfit::fit {
namespace {

struct FittedLine {
  double frequency_Hz = 0.0;
  double force = 0.0;  ///< amplitude
  bool is_of_mains = false;
};

std::vector<FittedLine> fitted_lines(const BlockFit& fit) {
  const double resolution_Hz = 1.0 / (fit.scales().time_end_s - fit.scales().time_begin_s);
  std::vector<FittedLine> lines;
  const double* wave = fit.wave_data();
  for (const double frequency_Hz : fit.level().lines_Hz) {
    const double force = fit.scales().force * std::hypot(wave[0], wave[1]);
    lines.push_back({frequency_Hz, force, signal::is_of_mains(frequency_Hz, resolution_Hz)});
    wave += 2;
  }
  return lines;
}

}  // namespace

double hum_amplitude(const BlockFit& fit) {
  double amplitude = 0.0;
  for (const FittedLine& line : fitted_lines(fit)) amplitude = std::hypot(amplitude, line.force);
  return amplitude;
}

double slope_by_lines(const BlockFit& fit, double length_s) {
  double slope = 0.0;
  for (const FittedLine& line : fitted_lines(fit)) {
    // A line of least squares through a sin(w t), from -x to x in w t, has the slope 3 a (sin x - x cos x) w / x^3. x
    // is not known to a fraction of a period: |sin x - x cos x| <= sqrt(1 + x^2), and the slope of the sine is at most
    // a w.
    const double omega = 2.0 * std::numbers::pi * line.frequency_Hz;
    const double x = 0.5 * omega * length_s;
    if (x > 0.0) slope += line.force * omega * std::min(1.0, 3.0 * std::hypot(1.0, x) / (x * x * x));
  }
  return slope;
}

double mains_amplitude(const BlockFit& fit) {
  double amplitude = 0.0;
  for (const FittedLine& line : fitted_lines(fit)) {
    if (line.is_of_mains) amplitude = std::hypot(amplitude, line.force);
  }
  return amplitude;
}

std::vector<double> hum_at_other_frequencies(const BlockFit& fit, const std::vector<double>& frequencies_Hz) {
  const double half_s = 0.5 * (fit.scales().time_end_s - fit.scales().time_begin_s);
  std::vector<double> coefficients(2 * frequencies_Hz.size(), 0.0);
  const double* const wave = fit.wave_data();
  const std::size_t known = std::min(frequencies_Hz.size(), fit.level().lines_Hz.size());
  for (std::size_t i = 0; i < known; ++i) {
    const double turn = 2.0 * std::numbers::pi * (fit.level().lines_Hz[i] - frequencies_Hz[i]) * half_s;
    const std::complex<double> line = std::complex(wave[2 * i], -wave[2 * i + 1]) * std::polar(1.0, turn);
    coefficients[2 * i] = line.real();
    coefficients[2 * i + 1] = -line.imag();
  }
  return coefficients;
}

bool is_same_hum(const BlockFit& fit, const std::vector<double>& frequencies_Hz) {
  constexpr double kNothing = 0.02;  // of the noise
  const std::vector<FittedLine> lines = fitted_lines(fit);
  if (lines.empty() || lines.size() != frequencies_Hz.size()) return false;
  const double span_s = fit.scales().time_end_s - fit.scales().time_begin_s;
  double difference = 0.0;  // root of the mean square over the recording, phases equal in its middle
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const double turns = (frequencies_Hz[i] - lines[i].frequency_Hz) * span_s;
    difference = std::hypot(difference, lines[i].force * turns * std::numbers::pi / std::sqrt(6.0));
  }
  return difference < kNothing * fit.scales().noise;
}

std::optional<StickRipple> fitted_ripple(const BlockFit& fit) {
  std::optional<StickRipple> largest;
  for (const FittedLine& line : fitted_lines(fit)) {
    const double share = speed_share(fit, line.frequency_Hz, line.force);
    const bool may_be_of_drive = !line.is_of_mains && share > thresholds::kRippleShare && share < 1.0;
    if (!may_be_of_drive || (largest && share < largest->speed_share)) continue;
    largest = StickRipple{line.frequency_Hz, line.force, share, 0.0};
  }
  return largest;
}

}  // namespace slipfit::fit
