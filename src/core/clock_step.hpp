#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace slipfit {

/// The number of steps at which a clock goes back, and at which it does not advance.
struct ClockOrder {
  std::size_t backward = 0;
  std::size_t repeating = 0;
};

ClockOrder order_of(std::span<const double> time_s);

/// Returns the median of the steps that are not zero, in s; 0 without any. `time_s` never decreases.
double median_positive_step(std::span<const double> time_s);

/// An even clock, and what its stamps were rounded to.
struct RoundedClock {
  double begin_s = 0.0;
  double step_s = 0.0;
  double rounding_s = 0.0;
};

/// The even clock whose stamps, rounded to more than half a step, these are: steps of two lengths, neither of them
/// rare, and no stamp farther from the even clock than its rounding and one lost sample explain. Empty for all other
/// stamps. `time_s` never decreases.
std::optional<RoundedClock> rounded_clock(std::span<const double> time_s);

}  // namespace slipfit
