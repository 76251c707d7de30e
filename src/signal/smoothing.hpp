#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "core/statistics.hpp"

namespace slipfit::signal {

/// Returns a stride at which enough values remain for a median: 40 000 of them determine it to 1 %.
inline std::size_t stride_for(std::size_t count) {
  constexpr std::size_t kEnough = 40000;
  return 1 + count / kEnough;
}

/// The ratio of the standard deviation to the median of |x| of a normal distribution.
inline constexpr double kMedianToSigma = 1.4826;

using slipfit::median;

/// Calls `action` with the index of every flag that is set. Looking for the next one takes a third of the instructions
/// of asking for each by its index.
template <typename Action>
void for_each_set(const std::vector<bool>& mask, const Action& action) {
  for (auto it = mask.begin(); (it = std::find(it, mask.end(), true)) != mask.end(); ++it) {
    action(static_cast<std::size_t>(it - mask.begin()));
  }
}

/// Means over any width of one trace, from two values of a table each.
class RunningMeans {
 public:
  explicit RunningMeans(std::span<const double> values);

  /// Returns the means of `width` samples starting at each sample; none if the trace is shorter.
  [[nodiscard]] std::vector<double> over(std::size_t width) const;

 private:
  friend class Means;
  std::vector<double> sums_;  ///< of the values before a sample, less the first value, which keeps them small
  double origin_ = 0.0;
};

/// Means over `width` samples, every `stride` samples: what a trace shows at one time scale. Computed on access: a long
/// trace at many scales would fill the memory, and writing it takes longer than the means. A width of 1 is the values
/// as they are, which sums would round. The values and their running means must outlive it.
class Means {
 public:
  Means(std::span<const double> values, const RunningMeans& sums, std::size_t width, std::size_t stride);

  [[nodiscard]] std::size_t width() const { return width_; }
  [[nodiscard]] std::size_t stride() const { return stride_; }
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Returns the sample at the middle of mean j.
  [[nodiscard]] std::size_t sample(std::size_t j) const { return j * stride_ + width_ / 2; }
  [[nodiscard]] double operator[](std::size_t j) const {
    const std::size_t i = j * stride_;
    return width_ == 1 ? values_[i] : origin_ + share_ * (sums_[i + width_] - sums_[i]);
  }
  /// The means from `first` on, as many as `into` holds.
  void copy(std::size_t first, std::span<double> into) const;

 private:
  std::span<const double> values_;
  std::span<const double> sums_;
  double origin_;
  double share_;
  std::size_t width_;
  std::size_t stride_;
  std::size_t size_ = 0;
};

/// Returns the standard deviation of the scatter from one width to the next, by second differences: ramps and a
/// wandering level do not contribute, nor do slips that take less than half of the time.
double noise_of(const Means& trace);

}  // namespace slipfit::signal
