#include "frequency_methods.hpp"

#include <fftw3.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "analysis/detect.hpp"
#include "signal/transform.hpp"
#include "slipfit/pipeline.hpp"

namespace atlas {
namespace {

using slipfit::Estimate;
using slipfit::Recording;

constexpr std::size_t kPadding = 16;

Estimate bare(double frequency_Hz) {
  return {frequency_Hz, {}, {}, {}};
}

/// Vertex of the parabola through three neighbours, as an offset from the middle one.
double vertex(double before, double at, double after) {
  const double bend = before - 2.0 * at + after;
  return bend < 0.0 ? 0.5 * (before - after) / bend : 0.0;
}

/// Largest bin but the first two: the window spreads the mean over them.
std::size_t largest_bin(const std::vector<double>& power) {
  return static_cast<std::size_t>(std::max_element(power.begin() + 2, power.end() - 1) - power.begin());
}

Estimate spectral_peak(const Recording& recording) {
  const slipfit::Spectrum spectrum = slipfit::compute_spectrum(recording);
  return bare(spectrum.bin_Hz * static_cast<double>(largest_bin(spectrum.power)));
}

Estimate interpolated_peak(const Recording& recording) {
  const slipfit::Spectrum spectrum = slipfit::compute_spectrum(recording);
  const std::size_t peak = largest_bin(spectrum.power);
  const auto log_power = [&](std::size_t bin) { return std::log(spectrum.power[bin] + 1e-300); };
  const double offset = vertex(log_power(peak - 1), log_power(peak), log_power(peak + 1));
  return bare(spectrum.bin_Hz * (static_cast<double>(peak) + offset));
}

Estimate zero_padded_peak(const Recording& recording) {
  const std::size_t length = slipfit::signal::good_length(kPadding * recording.size());
  std::vector<double> power = slipfit::signal::hann_power(recording.force(), length);
  std::fill_n(power.begin(), 2 * kPadding, 0.0);
  const std::size_t peak = largest_bin(power);
  const double offset = vertex(power[peak - 1], power[peak], power[peak + 1]);
  const double step_s = recording.duration_s() / static_cast<double>(recording.size() - 1);
  return bare((static_cast<double>(peak) + offset) / (step_s * static_cast<double>(length)));
}

std::vector<double> without_line(std::span<const double> force) {
  const auto count = static_cast<double>(force.size());
  double mean = 0.0;
  for (const double f : force) mean += f / count;
  double slope = 0.0;
  double spread = 0.0;
  for (std::size_t i = 0; i < force.size(); ++i) {
    const double x = static_cast<double>(i) - 0.5 * (count - 1.0);
    slope += x * (force[i] - mean);
    spread += x * x;
  }
  std::vector<double> values;
  for (std::size_t i = 0; i < force.size(); ++i) {
    values.push_back(force[i] - mean - slope / spread * (static_cast<double>(i) - 0.5 * (count - 1.0)));
  }
  return values;
}

/// Sum over products of values a lag apart (biased: long lags weigh less), by FFT.
std::vector<double> autocorrelation(std::vector<double> values) {
  const std::size_t length = slipfit::signal::good_length(2 * values.size());
  values.resize(length, 0.0);
  std::vector<std::complex<double>> lines(length / 2 + 1);
  auto* raw = static_cast<fftw_complex*>(static_cast<void*>(lines.data()));
  const int points = static_cast<int>(length);
  fftw_plan forward = fftw_plan_dft_r2c_1d(points, values.data(), raw, FFTW_ESTIMATE);
  fftw_plan backward = fftw_plan_dft_c2r_1d(points, raw, values.data(), FFTW_ESTIMATE);
  fftw_execute(forward);
  for (std::complex<double>& line : lines) line = std::norm(line);
  fftw_execute(backward);
  fftw_destroy_plan(forward);
  fftw_destroy_plan(backward);
  return values;
}

Estimate autocorrelation_peak(const Recording& recording) {
  const std::vector<double> sums = autocorrelation(without_line(recording.force()));
  const std::size_t half = recording.size() / 2;
  std::size_t first = 1;
  while (first < half && sums[first] > 0.0) ++first;
  const auto begin = sums.begin();
  const auto highest =
      std::max_element(begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(half));
  const auto lag = static_cast<std::size_t>(highest - begin);
  if (first + 1 >= half || lag <= first) return {};
  const double step_s = recording.duration_s() / static_cast<double>(recording.size() - 1);
  return bare(1.0 / (step_s * (static_cast<double>(lag) + vertex(sums[lag - 1], sums[lag], sums[lag + 1]))));
}

Estimate harmonic_comb(const Recording& recording) {
  const auto found = slipfit::find_frequency(recording, slipfit::compute_spectrum(recording), std::nullopt);
  if (!found.value_Hz || !found.standard_error_Hz) return {found.value_Hz, {}, {}, {}};
  const double half_Hz = 1.96 * *found.standard_error_Hz;
  return {found.value_Hz,
          found.standard_error_Hz,
          slipfit::Interval{*found.value_Hz - half_Hz, *found.value_Hz + half_Hz},
          {}};
}

Estimate counted_slips(const Recording& recording) {
  const slipfit::Quality quality = slipfit::assess_quality(recording);
  return slipfit::count_frequency(recording, slipfit::find_slips(recording, quality));
}

Estimate quoted_by_analyze(const Recording& recording) {
  return slipfit::analyze(recording).frequency.quoted;
}

Estimate quoted_by_fit(const Recording& recording) {
  return slipfit::analyze_and_fit(recording).frequency.quoted;
}

}  // namespace

std::vector<FrequencyMethod> frequency_methods() {
  return {{"FFT peak", spectral_peak},
          {"FFT peak, interpolated", interpolated_peak},
          {"FFT peak, 16 x zero-padded", zero_padded_peak},
          {"autocorrelation peak", autocorrelation_peak},
          {"slip counting (slipfit)", counted_slips},
          {"harmonic least squares (slipfit)", harmonic_comb},
          {"what slipfit analyze quotes", quoted_by_analyze},
          {"what slipfit fit quotes", quoted_by_fit}};
}

}  // namespace atlas
