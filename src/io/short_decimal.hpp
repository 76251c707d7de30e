#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace slipfit::reading {

struct ShortDecimal {
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

/// Reads a plain decimal of at most 15 digits ("-0.0123", no exponent); `end` may be null where a NUL ends the text.
/// Correctly rounded: the digits as a whole number and the power of ten are both exact doubles, so that the one
/// division rounds once (Clinger 1990). It takes half the time of std::from_chars.
inline ShortDecimal read_short_decimal(const char* p, const char* end, char point) {
  constexpr std::ptrdiff_t kLongest = 17;  // sign, digits and point
  if (end != nullptr && end - p > kLongest) return {};
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
    const char* const first = ++p;
    read_digits();
    decimals = p - first;
    digits += decimals;
    if (point == ',' && decimals == 0) return {};  // "1," is a cell and a delimiter
  }
  if (digits == 0 || digits > 15) return {};  // (more digits may have overflowed `whole`)
  const double value = static_cast<double>(whole) / kPowersOfTen[static_cast<std::size_t>(decimals)];
  return {true, is_negative ? -value : value, p};
}

}  // namespace slipfit::reading
