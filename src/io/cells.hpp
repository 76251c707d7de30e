#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace slipfit::reading {

/// The way in which a line is divided into cells and a number is written.
struct Dialect {
  char delimiter = ',';  ///< ',', ';', tab, ' ' for any run of blanks, NUL for one cell a line
  bool decimal_comma = false;
  bool comma_in_clock = false;  ///< "10:00:00,005,4.2" has two cells: a comma behind h:m:s begins its decimals
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

/// The end of the cell that begins at `cell` (for blanks: that begins there with no blank), at the latest that of the
/// line: `line_end`, or the NUL where that is null.
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

}  // namespace slipfit::reading
