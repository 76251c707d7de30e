#pragma once

#include <limits>
#include <optional>

#include "slipfit/core/estimate.hpp"

namespace slipfit {

/// The values that a quantity can have.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};
inline constexpr Range kAnyNumber{};
inline constexpr Range kNotNegative{0.0, std::numeric_limits<double>::infinity()};
inline constexpr Range kShare{0.0, 1.0};

/// The largest number that a document contains: no quantity of a test reaches it, and its powers are finite.
inline constexpr double kLargestNumber = 1e100;

/// Returns true for finite numbers, false for NaN and infinity.
bool is_finite(double number);

/// Returns the number if it is finite and in the range, or the end of the range if rounding exceeded it; otherwise
/// nothing.
std::optional<double> within(std::optional<double> number, const Range& range);

/// Returns the estimate as a document may contain it: a finite value in the range with a finite error, in a finite
/// interval that ends at the end of the range; otherwise the value is unknown and the note states the reason. (The
/// truth is always in the range, so a truncated interval has the same coverage.)
Estimate within(Estimate estimate, const Range& range);

}  // namespace slipfit
