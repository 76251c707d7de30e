#include "core/quantile.hpp"

namespace slipfit {
namespace {

/// Moves the values for which `is_first` holds to the front and counts them. Every value is moved, whatever it is.
template <class Predicate>
std::size_t partition(std::span<double> values, const Predicate& is_first) {
  std::size_t count = 0;
  for (double& place : values) {
    const double value = place;
    place = values[count];
    values[count] = value;
    count += is_first(value) ? std::size_t{1} : 0;
  }
  return count;
}

double median_of_three(double a, double b, double c) {
  return std::max(std::min(a, b), std::min(std::max(a, b), c));
}

}  // namespace

double nth_smallest(std::span<double> values, std::size_t index) {
  constexpr std::size_t kFew = 24;
  constexpr int kMostRounds = 64;  // pivots that part badly again and again are left to std::nth_element
  for (int round = 0; values.size() > kFew && round < kMostRounds; ++round) {
    const double pivot = median_of_three(values.front(), values[values.size() / 2], values.back());
    const std::size_t below = partition(values, [&](double value) { return value < pivot; });
    if (index < below) {
      values = values.first(below);
      continue;
    }
    const std::size_t equal = partition(values.subspan(below), [&](double value) { return value <= pivot; });
    if (index < below + equal) return pivot;
    if (below + equal == 0) break;  // the pivot is no number
    values = values.subspan(below + equal);
    index -= below + equal;
  }
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(index);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace slipfit
