#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <system_error>

#include "core/number_text.hpp"

namespace slipfit::reading {

struct Decimal {
  bool is_number = false;
  double value = 0.0;
  const char* end = nullptr;  ///< the first character that is not part of it
};

inline bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

// Not inside the function: g++ would copy the table to the stack for every number.
inline constexpr std::array kPowersOfTen = {1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                            1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};

/// Beyond it there is no number: SCPI instruments write 9.9e37 for infinity and 9.91e37 for what is none.
inline constexpr double kOverload = 9e36;

/// A number of many digits or with an exponent: `digits_end` is where its digits end.
inline Decimal read_long_decimal(const char* begin, const char* digits_end, const char* end) {
  const char* p = digits_end;
  if (p != end && (*p == 'e' || *p == 'E')) {
    ++p;
    if (p != end && (*p == '-' || *p == '+')) ++p;
    while (p != end && is_digit(*p)) ++p;
  }
  double value = 0.0;
  const auto [number_end, error] = number_from_chars(begin, p, value);
  if (error != std::errc() || !(std::abs(value) <= kOverload)) return {};
  return {true, value, number_end};
}

/// Reads a plain number without a plus in front; with a decimal comma, one of at most 15 digits and no exponent. `end`
/// may be null where a NUL ends the text. No number: ask a reader that takes more time.
/// Correctly rounded: up to 15 digits as a whole number and the power of ten are both exact doubles, so that the one
/// division rounds once (Clinger 1990). It takes half the time of std::from_chars.
inline Decimal read_decimal(const char* p, const char* end, char point) {
  const char* const first = p;
  const bool is_negative = p != end && *p == '-';
  if (is_negative) ++p;
  const char* const begin = p;
  std::uint64_t whole = 0;
  const auto read_digits = [&] {
    for (; p != end; ++p) {
      const unsigned digit = static_cast<unsigned>(*p) - '0';  // above 9 for whatever is none: one comparison
      if (digit > 9) break;
      whole = whole * 10 + digit;
    }
  };
  read_digits();
  std::ptrdiff_t digits = p - begin;
  std::ptrdiff_t decimals = 0;
  if (p != end && *p == point) {
    const char* const after_point = ++p;
    read_digits();
    decimals = p - after_point;
    digits += decimals;
  }
  if (digits == 0) return {};
  const bool has_exponent = p != end && (*p == 'e' || *p == 'E');
  if (digits > 15 || has_exponent) {  // more digits may have overflowed `whole`
    return point == '.' ? read_long_decimal(first, p, end) : Decimal{};
  }
  const double value = static_cast<double>(whole) / kPowersOfTen[static_cast<std::size_t>(decimals)];
  return {true, is_negative ? -value : value, p};
}

}  // namespace slipfit::reading
