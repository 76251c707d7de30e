#pragma once

#include <cstddef>
#include <span>

namespace slipfit {

/// How often a clock steps back, and how often it stands still.
struct ClockOrder {
  std::size_t backward = 0;
  std::size_t repeating = 0;
};

ClockOrder order_of(std::span<const double> time_s);

/// Median of the steps that are not zero, s; 0 where there is none. `time_s` never decreases.
double median_positive_step(std::span<const double> time_s);

}  // namespace slipfit
