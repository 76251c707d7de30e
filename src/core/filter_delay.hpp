#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>

namespace slipfit {

/// Returns the time by which a Butterworth filter of this order delays a slow ramp, times 2 pi and its corner: the
/// coefficient of s in its polynomial. It is the time constant of its slowest pole, too. docs/model.md section 7
inline double butterworth_delay(std::size_t order) {
  return 1.0 / std::sin(std::numbers::pi / (2.0 * static_cast<double>(order)));
}

}  // namespace slipfit
