#include "signal/smoothing.hpp"

#include <cmath>
#include <utility>

namespace slipfit::signal {

RunningMeans::RunningMeans(std::span<const double> values) : sums_(values.size() + 1, 0.0) {
  if (!values.empty()) origin_ = values.front();
  for (std::size_t i = 0; i < values.size(); ++i) sums_[i + 1] = sums_[i] + (values[i] - origin_);
}

std::vector<double> RunningMeans::over(std::size_t width) const {
  std::vector<double> means;
  const std::size_t samples = sums_.size() - 1;
  if (width > samples) return means;
  means.reserve(samples - width + 1);
  const double share = 1.0 / static_cast<double>(width);
  for (std::size_t i = 0; i + width <= samples; ++i) {
    means.push_back(origin_ + share * (sums_[i + width] - sums_[i]));
  }
  return means;
}

Means::Means(std::span<const double> values, const RunningMeans& sums, std::size_t width, std::size_t stride)
    : values_(values),
      sums_(sums.sums_),
      origin_(sums.origin_),
      share_(1.0 / static_cast<double>(width)),
      width_(width),
      stride_(stride) {
  if (width <= values.size()) size_ = (values.size() - width) / stride + 1;
}

void Means::copy(std::size_t first, std::span<double> into) const {
  const std::size_t begin = first * stride_;
  if (width_ == 1) {
    for (std::size_t k = 0; k < into.size(); ++k) into[k] = values_[begin + k * stride_];
  } else if (stride_ == 1) {  // apart, so that the compiler takes several at once
    const double* const low = sums_.data() + begin;
    const double* const high = low + width_;
    for (std::size_t k = 0; k < into.size(); ++k) into[k] = origin_ + share_ * (high[k] - low[k]);
  } else {
    for (std::size_t k = 0; k < into.size(); ++k) into[k] = (*this)[first + k];
  }
}

double noise_of(const Means& trace) {
  constexpr std::size_t kEnough = 4000;
  constexpr double kToSigma = kMedianToSigma / 2.449489743;  // a second difference has sqrt(6) of the deviation
  const std::size_t lag = (trace.width() + trace.stride() - 1) / trace.stride();
  if (trace.size() < 2 * lag + 1) return 0.0;
  const std::size_t differences = trace.size() - 2 * lag;
  std::vector<double> sizes;
  for (std::size_t i = 0; i < differences; i += 1 + differences / kEnough) {
    sizes.push_back(std::abs(trace[i] - 2.0 * trace[i + lag] + trace[i + 2 * lag]));
  }
  return kToSigma * median(std::move(sizes));
}

}  // namespace slipfit::signal
