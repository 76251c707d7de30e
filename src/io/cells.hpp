#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

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

/// The way in which a line is divided into cells and a number is written.
struct Dialect {
  char delimiter = ',';  ///< ',', ';', tab, ' ' for any run of blanks, NUL for one cell a line
  bool decimal_comma = false;
  bool comma_in_clock = false;  ///< "10:00:00,005,4.2" has two cells: a comma after h:m:s begins its decimals
};

enum class CellKind {
  Number,
  Clock,    ///< hh:mm:ss(.fff), value in seconds; with a date: since 1970
  Date,     ///< a date alone
  Blank,    ///< nothing
  Missing,  ///< nan, inf, n/a, ---, overflow: a reading that is none
  Text
};

struct Cell {
  CellKind kind = CellKind::Text;
  double value = 0.0;
  std::string_view tag;  ///< text after a number: "N1" in "1.79 N1"
};

/// Reads a cell with blanks around the number, a sign, exponents, quotes, and a tag that starts with a letter.
Cell read_cell(std::string_view text, bool decimal_comma);

/// A number that fills the text from end to end (blanks aside); the fast way, for the rows of a recording. NaN if not.
double plain_number(std::string_view text, bool decimal_comma);

/// Splits a line into its cells. Quotes protect delimiters and stay in the cell.
std::vector<std::string_view> split(std::string_view line, const Dialect& dialect);
/// Splits a line into a vector that is reused for every line.
void split(std::string_view line, const Dialect& dialect, std::vector<std::string_view>& cells);

/// Returns true if the comma at `comma`, in a line that starts at `begin`, is between h:m:s and a digit.
bool is_comma_in_clock(const char* begin, const char* comma, const char* line_end);

/// Returns the end of the cell that begins at `cell` (where blanks part the cells, not at a blank), at most the end of
/// the line: `line_end`, or the NUL if that is null.
inline const char* end_of_cell(const char* cell, const char* line_end, const Dialect& dialect) {
  const char delimiter = dialect.delimiter;
  const char* const begin = cell;
  const auto in_line = [line_end](const char* p) { return p != line_end && *p != '\0'; };
  if (in_line(cell) && *cell == '"') {
    const char* quote = cell + 1;
    while (in_line(quote) && *quote != '"') ++quote;
    if (in_line(quote)) cell = quote + 1;
  }
  if (delimiter == ' ') {
    while (in_line(cell) && *cell != ' ' && *cell != '\t') ++cell;
  } else {
    while (in_line(cell) && *cell != delimiter) ++cell;
    if (dialect.comma_in_clock && is_comma_in_clock(begin, cell, line_end)) {
      for (++cell; in_line(cell) && *cell != delimiter;) ++cell;
    }
  }
  return cell;
}

/// The fields of one line of CSV: blanks around them go, quotes go, "" inside quotes is one quote. Nothing where a
/// quote is not closed, or is followed by more text.
std::optional<std::vector<std::string>> csv_fields(std::string_view line, char delimiter);

/// Returns the text without blanks and one surrounding pair of quotes.
std::string_view unquote(std::string_view text);

struct DateStart {
  double midnight_s = 0.0;  ///< since 1970
  std::string_view clock;   ///< text after the date, without a time zone; may be empty
};

/// Reads a date such as "2024-05-12T12:22:17.5Z", "2024/05/12 12:22:17", "12.05.2024 12:22:17,5", "5/12/2024 12:22:17
/// PM"; empty if the text does not start with a date. The order of day and month in the last form is unknown, so its
/// midnight is 0 and its clock counts within the day.
std::optional<DateStart> read_date(std::string_view text);

/// Cells of one column and one shape that look like numbers and could not be read as such.
struct UnreadCells {
  std::size_t count = 0;
  std::size_t column = 0;
  unsigned first_line = 0;
  std::string example;  ///< the first of them
};

/// Counts cells that could not be read by their shape, in which a run of digits counts as one digit: "(0.25)" and
/// "(12.5)" have the same. A program that writes numbers in a way of its own leaves many cells of one shape; damage
/// leaves many shapes.
class UnreadCellCount {
 public:
  /// Cells without a digit, and those with letters (other than the e of an exponent), ':' or '/', do not count.
  void add(std::string_view cell, std::size_t column, unsigned line);
  /// The most frequent ones.
  [[nodiscard]] std::optional<UnreadCells> most() const;

 private:
  std::map<std::pair<std::size_t, std::string>, UnreadCells> by_shape_;  ///< by column and shape
};

}  // namespace slipfit::reading
