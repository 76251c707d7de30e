#include "core/clock_step.hpp"

#include <algorithm>
#include <cmath>

#include "core/statistics.hpp"

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

std::optional<RoundedClock> rounded_clock(std::span<const double> time_s) {
  constexpr std::size_t kFewest = 16;
  constexpr double kDigits = 0.01;  // of the rounding: what binary fractions leave
  constexpr double kOften = 0.05;   // of the steps: rarer long ones are lost samples of an otherwise even clock
  if (time_s.size() < kFewest) return std::nullopt;
  const double step_s = (time_s.back() - time_s.front()) / static_cast<double>(time_s.size() - 1);
  double shortest_s = time_s[1] - time_s[0];
  double longest_s = shortest_s;
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    shortest_s = std::min(shortest_s, time_s[i] - time_s[i - 1]);
    longest_s = std::max(longest_s, time_s[i] - time_s[i - 1]);
  }
  const double rounding_s = longest_s - shortest_s;
  if (!(rounding_s > 0.5 * step_s) || !(step_s > 0.0)) return std::nullopt;
  std::size_t longer = 0;
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    const double over_s = time_s[i] - time_s[i - 1] - shortest_s;
    if (std::min(over_s, rounding_s - over_s) > kDigits * rounding_s) return std::nullopt;
    longer += over_s > 0.5 * rounding_s ? std::size_t{1} : 0;
  }
  const double share = static_cast<double>(longer) / static_cast<double>(time_s.size() - 1);
  if (std::min(share, 1.0 - share) < kOften) return std::nullopt;
  const LineSums line = line_sums(
      time_s.size(), [](std::size_t i) { return static_cast<double>(i); }, [&](std::size_t i) { return time_s[i]; });
  double least_s = 0.0;
  double most_s = 0.0;
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    const double off_s = time_s[i] - line.at(static_cast<double>(i));
    least_s = std::min(least_s, off_s);
    most_s = std::max(most_s, off_s);
  }
  if (most_s - least_s > (1.0 + kDigits) * rounding_s + step_s) return std::nullopt;
  return RoundedClock{line.at(0.0), line.slope(), rounding_s};
}

}  // namespace slipfit
