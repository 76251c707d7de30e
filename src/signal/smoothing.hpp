#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace slipfit::signal {

/// Means over so many samples, every `stride` samples: what a trace shows at one time scale.
struct Smoothed {
  std::size_t width = 1;   ///< samples in a mean
  std::size_t stride = 1;  ///< samples from one mean to the next
  std::vector<double> values;

  /// Sample at the middle of the mean j.
  [[nodiscard]] std::size_t sample(std::size_t j) const { return j * stride + width / 2; }
};

/// Means over any width of one trace at the price of two look-ups each.
class RunningMeans {
 public:
  explicit RunningMeans(std::span<const double> values);

  /// Of `width` samples, at most the trace's.
  [[nodiscard]] Smoothed over(std::size_t width, std::size_t stride) const;

 private:
  std::vector<double> sums_;  ///< of the values before a sample, less the first value, which keeps them small
  double origin_ = 0.0;
};

/// Standard deviation of what scatters from one width to the next, by second differences: ramps and a wandering level
/// do not count, and slips do not while they take less than half of the time.
double noise_of(const Smoothed& trace);

}  // namespace slipfit::signal
