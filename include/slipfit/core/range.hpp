#pragma once

#include <limits>
#include <optional>

#include "slipfit/core/estimate.hpp"

namespace slipfit {

/// The numbers that a quantity can be.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};
inline constexpr Range kAnyNumber{};
inline constexpr Range kNotNegative{0.0, std::numeric_limits<double>::infinity()};
inline constexpr Range kShare{0.0, 1.0};

/// No quantity of a test reaches it, and its powers are finite: a number beyond it counts as infinite.
inline constexpr double kLargestNumber = 1e100;

/// NaN is not finite.
bool is_finite(double number);

/// The number, where it is finite and in the range; an end of the range where rounding carried it beyond.
std::optional<double> within(std::optional<double> number, const Range& range);

/// The estimate as a document may show it: a finite value of the range with a finite error, in a finite interval that
/// ends where the range ends; what is not so is unknown, and the note says why. (No truth lies beyond the range, so a
/// cut interval covers as often as before.)
Estimate within(Estimate estimate, const Range& range);

}  // namespace slipfit
