#include "slipfit/signal/spectrum.hpp"

#include "signal/transform.hpp"

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
