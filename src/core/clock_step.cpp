#include "core/clock_step.hpp"

#include "core/quantile.hpp"

namespace slipfit {
namespace {

std::vector<double> positive_steps(std::span<const double> time_s, std::size_t stride) {
  std::vector<double> steps;
  steps.reserve(time_s.size() / stride + 1);
  for (std::size_t i = 1; i < time_s.size(); i += stride) {
    if (time_s[i] > time_s[i - 1]) steps.push_back(time_s[i] - time_s[i - 1]);
  }
  return steps;
}

}  // namespace

// Counted, not searched: without a way out of the loop the compiler works on several values at once.
ClockOrder order_of(std::span<const double> time_s) {
  std::size_t backward = 0;
  std::size_t repeating = 0;
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    backward += time_s[i] < time_s[i - 1] ? std::size_t{1} : 0;
    repeating += time_s[i] == time_s[i - 1] ? std::size_t{1} : 0;
  }
  return {backward, repeating};
}

/// A clock's steps take few values, so that the median of some of them is mostly that of all, which counting proves.
double median_positive_step(std::span<const double> time_s) {
  constexpr std::size_t kSome = 16;
  const std::vector<double> some = positive_steps(time_s, kSome);
  if (some.empty()) return median(positive_steps(time_s, 1));
  const double guess = median(some);
  std::size_t positive = 0;
  std::size_t below = 0;
  std::size_t equal = 0;
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    const double step = time_s[i] - time_s[i - 1];
    positive += step > 0.0 ? std::size_t{1} : 0;
    below += (step > 0.0 ? std::size_t{1} : 0) & (step < guess ? std::size_t{1} : 0);
    equal += step == guess ? std::size_t{1} : 0;
  }
  const bool is_median = below <= positive / 2 && positive / 2 < below + equal;
  return is_median ? guess : median(positive_steps(time_s, 1));
}

}  // namespace slipfit
