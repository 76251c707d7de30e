#include "fit/level/mains_hum.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include "core/fit_thresholds.hpp"
#include "fit/level/stick_ripple.hpp"
#include "signal/mains.hpp"
#include "signal/transform.hpp"

namespace slipfit::fit {
namespace {

/// Cosine and sine amplitude of one frequency.
struct HumTerm {
  double frequency_Hz = 0.0;
  double cosine = 0.0;
  double sine = 0.0;
};

/// Residuals with the fitted hum put back; outliers, which would smear over the spectrum, are 0.
std::vector<double> with_hum(const Recording& recording, const BlockFit& fit, std::vector<double> values,
                             const std::vector<std::size_t>& outliers) {
  for (const std::size_t sample : outliers) values[sample] = 0.0;
  if (fit.level().lines_Hz.empty()) return values;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] != 0.0) values[i] += fit.model(0).hum_at(recording.time_s()[i], fit.level_data());
  }
  return values;
}

/// Least-squares amplitude of one frequency on an even clock: the phasor turns by a fixed step from sample to sample,
/// four of them side by side. Residuals of 0 are no samples.
HumTerm fit_term(const std::vector<double>& residuals, double step_s, double frequency_Hz) {
  using Lanes = Eigen::Array4d;
  const double step = 2.0 * std::numbers::pi * frequency_Hz * step_s;
  const double turn_c = std::cos(4.0 * step);
  const double turn_s = std::sin(4.0 * step);
  Lanes c(1.0, std::cos(step), std::cos(2.0 * step), std::cos(3.0 * step));
  Lanes s(0.0, std::sin(step), std::sin(2.0 * step), std::sin(3.0 * step));
  Lanes sum_cc = Lanes::Zero(), sum_cs = Lanes::Zero(), sum_rc = Lanes::Zero(), sum_rs = Lanes::Zero();
  Lanes sum_used = Lanes::Zero();
  for (std::size_t i = 0; i < residuals.size(); i += 4) {
    Lanes r = Lanes::Zero();
    if (i + 4 <= residuals.size()) {
      r = Eigen::Map<const Lanes>(&residuals[i]);
    } else {
      std::copy(residuals.begin() + static_cast<std::ptrdiff_t>(i), residuals.end(), r.data());
    }
    const Lanes present = (r.abs() * 1e300).min(1.0);  // r != 0, for which Eigen has no vector instruction
    sum_used += present;
    sum_cc += present * c * c;
    sum_cs += present * c * s;
    sum_rc += r * c;
    sum_rs += r * s;
    const Lanes next = c * turn_c - s * turn_s;
    s = c * turn_s + s * turn_c;
    c = next;
  }

  const double cc = sum_cc.sum(), cs = sum_cs.sum(), rc = sum_rc.sum(), rs = sum_rs.sum();
  const double ss = sum_used.sum() - cc;
  const double determinant = cc * ss - cs * cs;
  if (!(determinant > 0.0)) return {frequency_Hz, 0.0, 0.0};
  return {frequency_Hz, (rc * ss - rs * cs) / determinant, (rs * cc - rc * cs) / determinant};
}

double step_of(const Recording& recording) {
  return recording.duration_s() / static_cast<double>(recording.size() - 1);
}

double power_of(const HumTerm& term) {
  return term.cosine * term.cosine + term.sine * term.sine;
}

/// Half a resolution on either side in steps of a quarter, then the vertex of a parabola through the best three.
double refine(const std::vector<double>& residuals, double step_s, double frequency_Hz, double resolution_Hz) {
  constexpr int kSteps = 2;
  std::vector<double> powers;
  for (int i = -kSteps; i <= kSteps; ++i) {
    powers.push_back(power_of(fit_term(residuals, step_s, frequency_Hz + 0.25 * i * resolution_Hz)));
  }
  const auto best = static_cast<std::size_t>(std::max_element(powers.begin(), powers.end()) - powers.begin());
  double offset = static_cast<double>(best) - kSteps;
  if (best > 0 && best + 1 < powers.size()) {
    const double curvature = powers[best - 1] - 2.0 * powers[best] + powers[best + 1];
    if (curvature < 0.0) offset += 0.5 * (powers[best - 1] - powers[best + 1]) / curvature;
  }
  return frequency_Hz + 0.25 * offset * resolution_Hz;
}

/// Of the lines that the fit has. `values`: residuals with its hum put back.
std::vector<double> refine_all(const Recording& recording, const BlockFit& fit, const std::vector<double>& values) {
  std::vector<double> frequencies_Hz;
  for (const double known_Hz : fit.level().lines_Hz) {
    frequencies_Hz.push_back(refine(values, step_of(recording), known_Hz, 1.0 / recording.duration_s()));
  }
  return frequencies_Hz;
}

/// Amplitude^2 from the peak of a Hann spectrum of `samples` values. Residuals of 0 among them and a line between bins
/// make it smaller than it is.
double power_in_spectrum(const std::vector<double>& power, double bin_Hz, std::size_t samples, double frequency_Hz) {
  const auto bin = static_cast<std::size_t>(std::lround(frequency_Hz / bin_Hz));
  const std::size_t padded_samples = 2 * (power.size() - 1);
  return 3.0 * power[bin] * static_cast<double>(padded_samples) / static_cast<double>(samples);
}

/// Amplitude^2 samples / (2 variance), which noise brings above x once in exp(x / 2).
struct Prominence {
  double used = 0.0;
  double square = 0.0;

  explicit Prominence(const std::vector<double>& residuals) {
    for (const double r : residuals) {
      used += r != 0.0 ? 1.0 : 0.0;
      square += r * r;
    }
  }
  [[nodiscard]] double of(double amplitude_squared) const { return 0.5 * amplitude_squared * used * used / square; }
};

/// A line that has the same phase at the onset of every slip cannot be told from the shape of the cycles: the length of
/// the mean of the phases' unit vectors is then 1, of phases that have nothing to do with the slips 1 / sqrt(cycles).
bool is_in_step(const BlockFit& fit, double frequency_Hz) {
  std::complex<double> sum;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    sum += std::polar(1.0, 2.0 * std::numbers::pi * frequency_Hz * (fit.state(i).onset_s - fit.state(0).onset_s));
  }
  return std::abs(sum) > thresholds::kInStep * static_cast<double>(fit.size());
}

struct FittedLine {
  double frequency_Hz = 0.0;
  double force = 0.0;  ///< amplitude
  bool is_of_mains = false;
};

std::vector<FittedLine> fitted_lines(const BlockFit& fit) {
  const double resolution_Hz = 1.0 / (fit.scales().time_end_s - fit.scales().time_begin_s);
  std::vector<FittedLine> lines;
  const double* wave = fit.parameters.level.data() + fit.level().first_line();
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
  const double* const wave = fit.parameters.level.data() + fit.level().first_line();
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

std::vector<double> refine_hum(const Recording& recording, const BlockFit& fit, std::vector<double> residuals) {
  return refine_all(recording, fit, with_hum(recording, fit, std::move(residuals), {}));
}

std::vector<double> find_hum(const Recording& recording, const BlockFit& fit, std::vector<double> residuals,
                             const std::vector<std::size_t>& outliers, const std::optional<StickRipple>& in_sticks) {
  if (!recording.clock_is_even()) return {};
  const std::vector<double> values = with_hum(recording, fit, std::move(residuals), outliers);
  const double step_s = step_of(recording);
  const std::size_t length = signal::good_length(values.size());
  const std::vector<double> power = signal::hann_power(values, length);
  const double bin_Hz = 1.0 / (static_cast<double>(length) * step_s);
  const double resolution_Hz = 1.0 / recording.duration_s();

  // A new line is taken where its peak is; its hum must be fitted before its frequency is worth refining.
  std::vector<double> frequencies_Hz = refine_all(recording, fit, values);
  const auto is_new = [&](double f_Hz) {
    const auto is_near = [&](double f) { return std::abs(f - f_Hz) < 2.0 * resolution_Hz; };
    return std::none_of(frequencies_Hz.begin(), frequencies_Hz.end(), is_near) && !is_in_step(fit, f_Hz);
  };
  if (in_sticks && is_new(in_sticks->frequency_Hz)) frequencies_Hz.push_back(in_sticks->frequency_Hz);
  const std::vector<signal::MainsLine> lines = signal::find_mains(power, bin_Hz, resolution_Hz);
  if (lines.empty()) return frequencies_Hz;
  // find_mains compares a line with its surroundings, which are too low where the fitted cycles have removed noise near
  // their harmonics: a line must also be improbable against the noise of all residuals.
  const Prominence prominence(values);
  for (const signal::MainsLine& line : lines) {
    const double f_Hz = line.frequency_Hz;
    if (!is_new(f_Hz)) continue;
    if (prominence.of(power_in_spectrum(power, bin_Hz, values.size(), f_Hz)) > 2.0 * thresholds::kSureHum ||
        prominence.of(power_of(fit_term(values, step_s, f_Hz))) > thresholds::kSureHum) {
      frequencies_Hz.push_back(f_Hz);
    }
  }
  return frequencies_Hz;
}

}  // namespace slipfit::fit
