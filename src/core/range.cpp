#include "slipfit/core/range.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/unknown.hpp"

namespace slipfit {
namespace {

/// Returns the interval restricted to the range and extended to the value.
std::optional<Interval> cut(const Interval& interval, const std::optional<double>& value, const Range& range) {
  Interval result{std::max(interval.low, range.low), std::min(interval.high, range.high)};
  if (value) result = {std::min(result.low, *value), std::max(result.high, *value)};
  const bool is_interval = is_finite(result.low) && is_finite(result.high) && result.low <= result.high;
  return is_interval ? std::optional(result) : std::nullopt;
}

}  // namespace

bool is_finite(double number) {
  return std::abs(number) <= kLargestNumber;
}

std::optional<double> within(std::optional<double> number, const Range& range) {
  constexpr double kRounding = 1e-9;  // of the width of the range
  if (!number || !is_finite(*number)) return std::nullopt;
  const double width = range.high - range.low;
  const double slack = std::isfinite(width) ? kRounding * width : 0.0;
  if (*number < range.low - slack || *number > range.high + slack) return std::nullopt;
  return std::clamp(*number, range.low, range.high);
}

Estimate within(Estimate estimate, const Range& range) {
  const bool had_value = estimate.value.has_value();
  const bool had_interval = estimate.ci95.has_value();
  estimate.value = within(estimate.value, range);
  if (had_value && !estimate.value) {
    add_note(estimate.note, "the data give no finite value within its possible range");
    estimate.standard_error = std::nullopt;
    estimate.ci95 = std::nullopt;
    return estimate;
  }
  estimate.standard_error = estimate.value ? within(estimate.standard_error, kNotNegative) : std::nullopt;
  if (had_interval) estimate.ci95 = cut(*estimate.ci95, estimate.value, range);
  if (had_interval && !estimate.ci95) add_note(estimate.note, "the data give no finite interval");
  return estimate;
}

}  // namespace slipfit
