#include "signal/smoothing.hpp"

#include <cmath>
#include <utility>

#include "signal/robust.hpp"

namespace slipfit::signal {

RunningMeans::RunningMeans(std::span<const double> values) : sums_(values.size() + 1, 0.0) {
  if (!values.empty()) origin_ = values.front();
  for (std::size_t i = 0; i < values.size(); ++i) sums_[i + 1] = sums_[i] + (values[i] - origin_);
}

Smoothed RunningMeans::over(std::size_t width, std::size_t stride) const {
  Smoothed trace{width, stride, {}};
  const std::size_t samples = sums_.size() - 1;
  if (width > samples) return trace;
  trace.values.reserve((samples - width) / stride + 1);
  const double share = 1.0 / static_cast<double>(width);
  for (std::size_t i = 0; i + width <= samples; i += stride) {
    trace.values.push_back(origin_ + share * (sums_[i + width] - sums_[i]));
  }
  return trace;
}

double noise_of(const Smoothed& trace) {
  constexpr std::size_t kEnough = 4000;
  constexpr double kToSigma = kMedianToSigma / 2.449489743;  // a second difference has sqrt(6) of the deviation
  const std::size_t lag = (trace.width + trace.stride - 1) / trace.stride;
  if (trace.values.size() < 2 * lag + 1) return 0.0;
  const std::size_t differences = trace.values.size() - 2 * lag;
  std::vector<double> sizes;
  for (std::size_t i = 0; i < differences; i += 1 + differences / kEnough) {
    sizes.push_back(std::abs(trace.values[i] - 2.0 * trace.values[i + lag] + trace.values[i + 2 * lag]));
  }
  return kToSigma * median(std::move(sizes));
}

}  // namespace slipfit::signal
