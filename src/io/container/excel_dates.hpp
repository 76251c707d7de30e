#pragma once

#include <string>
#include <string_view>

namespace slipfit::reading {

/// What the style of a cell makes of its number.
enum class DateStyle { None, Date, Clock };

/// The day that number 0 stands for.
enum class DateSystem { Since1900, Since1904 };

/// By the number of one of Excel's own formats (ECMA-376 part 1, 18.8.30).
DateStyle built_in_date_style(unsigned format);

/// By a format such as "yyyy-mm-dd hh:mm" or "[h]:mm:ss.000".
DateStyle date_style(std::string_view format);

/// Days as "2024-05-12 12:22:17.581000", or as hours, minutes and seconds; to the microsecond, which is what a double
/// holds of a date.
std::string date_text(double days, DateStyle style, DateSystem system);

}  // namespace slipfit::reading
