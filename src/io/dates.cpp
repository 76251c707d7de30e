#include "io/cells.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cstddef>

namespace slipfit::reading {
namespace {

struct DateParts {
  std::array<int, 3> numbers{};
  std::array<std::size_t, 3> digits{};
  char separator = '\0';
  std::size_t length = 0;
};

/// Three numbers with the same sign between them.
std::optional<DateParts> read_parts(std::string_view text) {
  DateParts parts;
  const char* p = text.data();
  const char* const end = p + text.size();
  for (std::size_t i = 0; i < 3; ++i) {
    if (i > 0 && (p == end || (i == 2 && *p != parts.separator))) return std::nullopt;
    if (i > 0) parts.separator = *p++;
    const auto [stop, error] = std::from_chars(p, end, parts.numbers.at(i));
    if (error != std::errc() || parts.numbers.at(i) < 0) return std::nullopt;
    parts.digits.at(i) = static_cast<std::size_t>(stop - p);
    p = stop;
  }
  parts.length = static_cast<std::size_t>(p - text.data());
  return parts;
}

/// "Z", "+02:00", "-0500" at the end of an ISO time: the same for all rows.
std::string_view without_zone(std::string_view clock) {
  if (clock.ends_with('Z')) return clock.substr(0, clock.size() - 1);
  const std::size_t sign = clock.find_last_of("+-");
  return sign == std::string_view::npos ? clock : clock.substr(0, sign);
}

}  // namespace

std::optional<DateStart> read_date(std::string_view text) {
  const auto parts = read_parts(text);
  if (!parts) return std::nullopt;
  std::string_view clock = text.substr(parts->length);
  if (!clock.empty() && clock.front() != ' ' && clock.front() != 'T') return std::nullopt;
  if (!clock.empty()) clock.remove_prefix(1);
  while (clock.starts_with(' ')) clock.remove_prefix(1);
  const auto& [first, second, third] = parts->numbers;
  const bool is_ISO = (parts->separator == '-' || parts->separator == '/') && parts->digits[0] == 4;
  const bool is_German = parts->separator == '.' && (parts->digits[2] == 4 || parts->digits[2] == 2);
  const bool is_slashed = parts->separator == '/' && (parts->digits[2] == 4 || parts->digits[2] == 2);
  if (!is_ISO && is_slashed && std::max(first, second) <= 31 && std::min(first, second) <= 12) {
    return DateStart{0.0, clock};
  }
  if (!is_ISO && !is_German) return std::nullopt;
  const int century = parts->digits[2] == 2 ? 2000 : 0;
  using namespace std::chrono;
  const year_month_day date =
      is_ISO ? year_month_day{year{first}, month{static_cast<unsigned>(second)}, day{static_cast<unsigned>(third)}}
             : year_month_day{year{century + third}, month{static_cast<unsigned>(second)},
                              day{static_cast<unsigned>(first)}};
  if (!date.ok()) return std::nullopt;
  const auto since_1970 = sys_days{date}.time_since_epoch();
  return DateStart{86400.0 * static_cast<double>(since_1970.count()), is_ISO ? without_zone(clock) : clock};
}

}  // namespace slipfit::reading
