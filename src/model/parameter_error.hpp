#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "slipfit/core/result.hpp"

namespace slipfit::model {

/// A number for a message: six digits, never a row of zeros.
inline std::string short_text(double value) {
  std::array<char, 32> digits{};
  std::snprintf(digits.data(), digits.size(), "%g", value);
  return digits.data();
}

/// The error of a parameter that no body can have.
inline Error out_of_range(const std::string& name, double value, const std::string& expected) {
  return {"parameter_out_of_range", name + " is " + short_text(value) + ", expected " + expected};
}

inline bool is_positive(double value) {
  return std::isfinite(value) && value > 0.0;
}

}  // namespace slipfit::model
