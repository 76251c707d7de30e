#include "signal/transform.hpp"

#include <algorithm>
#include <array>
#include <complex>
#include <memory>
#include <mutex>
#include <numbers>
#include <utility>

#include "signal/defects.hpp"
#include "signal/fftw.hpp"
#include "slipfit/signal/spectrum.hpp"

namespace slipfit::signal {

namespace {

using Complex = std::complex<double>;

struct Line {
  double at_middle = 0.0;
  double slope = 0.0;  ///< per sample
};

Line fit_line(std::span<const double> values) {
  const auto n = static_cast<double>(values.size());
  const double middle = 0.5 * (n - 1.0);
  const double first = values.front();  // taken off so that a small signal on a large level keeps its digits
  double sum = 0.0;
  double moment = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    sum += values[i] - first;
    moment += (values[i] - first) * (static_cast<double>(i) - middle);
  }
  const double spread = n * (n * n - 1.0) / 12.0;
  return {first + sum / n, spread > 0.0 ? moment / spread : 0.0};
}

/// Detrended, windowed values as the real and imaginary parts of half as many complex ones, padded with zeros.
ComplexTransform::Buffer windowed(std::span<const double> values, std::size_t padded_length) {
  ComplexTransform::Buffer buffer = ComplexTransform::allocate(padded_length / 2);
  auto* out = static_cast<double*>(static_cast<void*>(buffer.get()));
  const Line line = fit_line(values);
  const double middle = 0.5 * static_cast<double>(values.size() - 1);
  const double step = 2.0 * std::numbers::pi / static_cast<double>(values.size());
  const Turns turns(0.5 * step, step);  // zero half a sample outside either end
  for (std::size_t begin = 0; begin < values.size(); begin += Turns::kBlock) {
    const Complex turn = turns.begin_of(begin / Turns::kBlock);
    const std::size_t count = std::min(Turns::kBlock, values.size() - begin);
    const double first = static_cast<double>(begin) - middle;
    for (std::size_t k = 0; k < count; ++k) {
      const double window = 0.5 - 0.5 * turns.cosine(turn, k);
      // As an int: SSE2 has no conversion of longer ones.
      const double place = first + static_cast<double>(static_cast<int>(k));
      out[begin + k] = window * (values[begin + k] - line.at_middle - line.slope * place);
    }
  }
  std::fill(out + values.size(), out + padded_length, 0.0);
  return buffer;
}

/// The plan for this length. The latest ones are kept for all threads: a recording is transformed several times, and a
/// batch meets the same lengths again.
std::shared_ptr<const ComplexTransform> transform_of(std::size_t length) {
  static std::array<std::shared_ptr<const ComplexTransform>, 4> latest;
  const std::lock_guard guard(PlanLocks::get().kept);
  const auto known = std::ranges::find_if(latest, [&](const auto& plan) { return plan && plan->length() == length; });
  const bool is_new = known == latest.end();
  const auto first = is_new ? known - 1 : known;
  std::rotate(latest.begin(), first, first + 1);
  if (is_new) latest.front() = std::make_shared<ComplexTransform>(length);
  return latest.front();
}

/// |X_k|^2 of the real series of length 2 M whose even and odd values are the parts of the M complex ones in z.
std::vector<double> real_power(const Complex* z, std::size_t half, double scale) {
  std::vector<double> power(half + 1);
  const double step = -std::numbers::pi / static_cast<double>(half);
  for_turns(half / 2 + 1, 0.0, step, [&](std::size_t k, double c, double s) {
    const Complex a = z[k];
    const Complex b = std::conj(z[k == 0 ? 0 : half - k]);
    const Complex even = 0.5 * (a + b);
    const Complex difference = 0.5 * (a - b);
    const Complex odd(difference.imag(), -difference.real());
    const Complex turned(odd.real() * c - odd.imag() * s, odd.real() * s + odd.imag() * c);
    const double both = std::norm(even) + std::norm(odd);
    const double cross = 2.0 * (even.real() * turned.real() + even.imag() * turned.imag());
    power[k] = scale * std::max(0.0, both + cross);
    power[half - k] = scale * std::max(0.0, both - cross);
  });
  power[half] *= 0.5;
  return power;
}

}  // namespace

UniformTrace resample(const Recording& recording, const std::vector<bool>& held) {
  const std::span<const double> time = recording.time_s();
  const std::span<const double> force = recording.force();
  if (recording.clock_is_even()) {  // the samples stay where they are
    return {recording.duration_s() / static_cast<double>(force.size() - 1), bridged(force, held)};
  }
  // Not more than twice the samples: a clock of bursts and long gaps must not fill the memory.
  const double step =
      std::max(recording.sample_interval_s(), recording.duration_s() / (2.0 * static_cast<double>(time.size())));
  UniformTrace trace{step, {}};
  const auto count = static_cast<std::size_t>(recording.duration_s() / step + 1e-6) + 1;
  trace.force.reserve(count);
  std::size_t last = time.size() - 1;
  while (last > 0 && !held.empty() && held[last]) --last;
  const auto good_from = [&](std::size_t i) {
    while (i < last && !held.empty() && held[i]) ++i;
    return i;
  };
  std::size_t left = good_from(0);
  std::size_t right = good_from(std::min(left + 1, last));
  for (std::size_t k = 0; k < count; ++k) {
    const double at = time.front() + step * static_cast<double>(k);
    while (time[right] < at && right < last) {
      left = right;
      right = good_from(right + 1);
    }
    const double span = time[right] - time[left];
    const double share = span > 0.0 ? std::clamp((at - time[left]) / span, 0.0, 1.0) : 1.0;
    trace.force.push_back(force[left] + share * (force[right] - force[left]));
  }
  return trace;
}

std::optional<Recording> on_even_clock(const Recording& recording, const std::vector<bool>& held) {
  if (recording.clock_is_even()) return std::nullopt;
  UniformTrace trace = resample(recording, held);
  std::vector<double> time_s(trace.force.size());
  for (std::size_t i = 0; i < time_s.size(); ++i) time_s[i] = trace.step_s * static_cast<double>(i);
  auto even = Recording::create(std::move(time_s), std::move(trace.force), recording.conditions());
  return even ? std::optional(std::move(even).value()) : std::nullopt;
}

std::vector<double> thin(std::span<const double> values, std::size_t factor) {
  const std::size_t count = values.size() / factor;
  std::vector<double> thinned(count, 0.0);
  const double level = values.front();
  const double scale = 1.0 / static_cast<double>(factor * factor);
  for (std::size_t j = 0; j < count; ++j) {
    const std::size_t begin = j * factor;
    double sum = 0.0;
    double falling = 0.0;  // sum of (1 - place) * value: the rest belongs to the next one
    for (std::size_t k = 0; k < factor; ++k) {
      const double value = values[begin + k] - level;
      sum += value;
      falling += value * (static_cast<double>(factor - k) - 0.5);
    }
    thinned[j] += falling * scale;
    if (j + 1 < count) thinned[j + 1] += (sum * static_cast<double>(factor) - falling) * scale;
  }
  if (count > 1) thinned[0] *= 2.0;  // half of its triangle lies before the trace
  return thinned;
}

std::size_t good_length(std::size_t length) {
  for (std::size_t half = std::max<std::size_t>(2, (length + 1) / 2);; ++half) {
    std::size_t rest = half;
    for (const std::size_t prime : {2U, 3U, 5U, 7U}) {
      while (rest % prime == 0) rest /= prime;
    }
    if (rest == 1) return 2 * half;
  }
}

std::vector<double> hann_power(std::span<const double> values, std::size_t padded_length) {
  const std::size_t half = padded_length / 2;
  const ComplexTransform::Buffer transformed = transform_of(half)->run(windowed(values, padded_length));
  const double window_energy = 0.375 * static_cast<double>(values.size());  // sum of squares of the Hann window
  std::vector<double> power =
      real_power(transformed.get(), half, 2.0 / (static_cast<double>(padded_length) * window_energy));
  power[0] = 0.0;
  return power;
}

}  // namespace slipfit::signal

namespace slipfit {

Spectrum compute_spectrum(const Recording& recording, const std::vector<bool>& held) {
  if (held.empty() && recording.clock_is_even()) {
    const double step = recording.duration_s() / static_cast<double>(recording.size() - 1);
    const std::size_t length = signal::good_length(recording.size());
    return {1.0 / (step * static_cast<double>(length)), signal::hann_power(recording.force(), length)};
  }
  const signal::UniformTrace trace = signal::resample(recording, held);
  const std::size_t length = signal::good_length(trace.force.size());
  return {1.0 / (trace.step_s * static_cast<double>(length)), signal::hann_power(trace.force, length)};
}

}  // namespace slipfit
