#pragma once

#include <charconv>

#ifdef SLIPFIT_USE_FAST_FLOAT
#include <fast_float/fast_float.h>

#include <algorithm>
#include <cmath>
#include <system_error>
#endif

namespace slipfit {

/// std::from_chars of a number, also where the standard library has it for integers alone.
#ifdef SLIPFIT_USE_FAST_FLOAT
inline std::from_chars_result number_from_chars(const char* begin, const char* end, double& value) {
  double read = 0.0;
  const auto [stop, error] = fast_float::from_chars(begin, end, read);
  const auto is_nonzero = [](char c) { return c >= '1' && c <= '9'; };
  const char* const exponent = std::find_if(begin, stop, [](char c) { return c == 'e' || c == 'E'; });
  const bool is_beyond = std::isinf(read) ? std::any_of(begin, exponent, is_nonzero)
                                          : read == 0.0 && std::any_of(begin, exponent, is_nonzero);
  if (error == std::errc() && is_beyond) return {stop, std::errc::result_out_of_range};
  if (error == std::errc()) value = read;
  return {stop, error};
}
#else
inline std::from_chars_result number_from_chars(const char* begin, const char* end, double& value) {
  return std::from_chars(begin, end, value);
}
#endif

}  // namespace slipfit
