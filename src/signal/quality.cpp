#include "slipfit/signal/quality.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "core/thresholds.hpp"
#include "signal/defects.hpp"
#include "signal/robust.hpp"

namespace slipfit {
namespace {

/// Noise from differences of one order, their coefficients and the root of the sum of their squares given.
template <std::size_t N>
double difference_noise(std::span<const double> force, const std::array<double, N>& coefficients, double norm) {
  std::vector<double> sizes;
  if (force.size() < N) return 0.0;
  const std::size_t stride = signal::stride_for(force.size());
  sizes.reserve(force.size() / stride + 1);
  for (std::size_t i = 0; i + N <= force.size(); i += stride) {
    double difference = 0.0;
    for (std::size_t k = 0; k < N; ++k) difference += coefficients[k] * force[i + k];
    sizes.push_back(std::abs(difference));
  }
  return signal::kMedianToSigma * signal::median(std::move(sizes)) / norm;
}

/// Second differences do not see ramps, fourth ones do not see the bends of a wave with few samples a period either.
double noise_of(std::span<const double> force) {
  const double second = difference_noise(force, std::array{1.0, -2.0, 1.0}, std::sqrt(6.0));
  const double fourth = difference_noise(force, std::array{1.0, -4.0, 6.0, -4.0, 1.0}, std::sqrt(70.0));
  return force.size() < 5 ? second : std::min(second, fourth);
}

/// More than half of the second differences are nought (values held or rounded): their rms, large ones cut.
double noise_of_held(std::span<const double> force) {
  std::vector<double> sizes;
  for (std::size_t i = 1; i + 1 < force.size(); ++i) {
    const double bend = std::abs(force[i - 1] - 2.0 * force[i] + force[i + 1]);
    if (bend > 0.0) sizes.push_back(bend);
  }
  if (sizes.empty()) return 0.0;
  const double share = static_cast<double>(sizes.size()) / static_cast<double>(force.size());
  return signal::median(std::move(sizes)) * std::sqrt(share / 6.0);
}

void assess_clock(const Recording& recording, Quality& quality) {
  const std::span<const double> time = recording.time_s();
  const double usual = recording.sample_interval_s();
  const std::size_t stride = signal::stride_for(time.size());
  const double gap_s = thresholds::kGapSteps * usual;
  for (std::size_t i = 1; i < time.size(); ++i) quality.gaps += time[i] - time[i - 1] > gap_s ? std::size_t{1} : 0;
  for (std::size_t i = 1; i < time.size() && quality.gaps > 0; ++i) {
    if (const double step = time[i] - time[i - 1]; step > gap_s) {
      quality.longest_gap_s = std::max(quality.longest_gap_s, step);
    }
  }
  std::vector<double> deviations;
  for (std::size_t i = stride; i < time.size(); i += stride) {
    if (const double step = time[i] - time[i - 1]; step <= gap_s) deviations.push_back(std::abs(step - usual));
  }
  quality.clock_jitter = signal::kMedianToSigma * signal::median(std::move(deviations)) / usual;
}

}  // namespace

Quality assess_quality(const Recording& recording) {
  Quality quality;
  const std::span<const double> force = recording.force();
  const std::optional<double> step = signal::lattice_step(force);
  quality.noise_rms = noise_of(force);
  if (quality.noise_rms <= 0.0) quality.noise_rms = noise_of_held(force);
  if (step) {
    quality.quantisation_step = step;
    quality.noise_rms = std::max(quality.noise_rms, *step / std::sqrt(12.0));  // rounding alone makes that much
  }
  const signal::Clipping clipping = signal::find_clipping(force, step);
  quality.clip_high = clipping.high;
  quality.clip_low = clipping.low;
  quality.clipped_samples = clipping.samples;
  quality.impulse_mask = signal::find_impulses(force, quality.noise_rms);
  quality.impulses = static_cast<std::size_t>(std::ranges::count(quality.impulse_mask, true));
  assess_clock(recording, quality);
  return quality;
}

}  // namespace slipfit
