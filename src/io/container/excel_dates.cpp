#include "io/container/excel_dates.hpp"

#include <fmt/format.h>

#include <cctype>
#include <chrono>
#include <cmath>

namespace slipfit::reading {

DateStyle built_in_date_style(unsigned format) {
  if ((format >= 18 && format <= 21) || (format >= 45 && format <= 47)) return DateStyle::Clock;
  return format >= 14 && format <= 22 ? DateStyle::Date : DateStyle::None;
}

DateStyle date_style(std::string_view format) {
  bool has_clock = false;
  for (std::size_t i = 0; i < format.size(); ++i) {
    if (format[i] == '"') {
      i = std::min(format.find('"', i + 1), format.size());
      continue;
    }
    if (format[i] == '\\') {
      ++i;
      continue;
    }
    if (format[i] == '[' && format.substr(i + 1, 1).find_first_of("hHmMsS") == std::string_view::npos) {
      i = std::min(format.find(']', i), format.size());  // a colour or a locale
      continue;
    }
    const char letter = static_cast<char>(std::tolower(static_cast<unsigned char>(format[i])));
    if (letter == 'y' || letter == 'd') return DateStyle::Date;
    has_clock = has_clock || letter == 'h' || letter == 's';
  }
  return has_clock ? DateStyle::Clock : DateStyle::None;
}

std::string date_text(double days, DateStyle style, DateSystem system) {
  constexpr double kMostDays = 2958466.0;  // the year 9999
  constexpr long long kDay_us = 86400LL * 1000000;
  if (!(days >= 0.0 && days < kMostDays)) return "nan";
  const auto microseconds = std::llround(days * static_cast<double>(kDay_us));
  const auto clock = [](long long us) {
    return fmt::format("{:02}:{:02}:{:02}.{:06}", us / 3600000000, us / 60000000 % 60, us / 1000000 % 60, us % 1000000);
  };
  if (style == DateStyle::Clock) return clock(microseconds);
  using namespace std::chrono;
  const sys_days zero = system == DateSystem::Since1900 ? sys_days{year{1899} / 12 / 30} : sys_days{year{1904} / 1 / 1};
  const year_month_day day{zero + std::chrono::days{microseconds / kDay_us}};
  return fmt::format("{:04}-{:02}-{:02} {}", static_cast<int>(day.year()), static_cast<unsigned>(day.month()),
                     static_cast<unsigned>(day.day()), clock(microseconds % kDay_us));
}

}  // namespace slipfit::reading
