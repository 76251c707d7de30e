#include "core/csv_line.hpp"

#include "slipfit/core/printable.hpp"

namespace slipfit {

std::string csv_line(const std::vector<std::string>& cells) {
  std::string line;
  for (const std::string& cell : cells) {
    if (&cell != &cells.front()) line += ',';
    const bool is_plain = cell.find_first_of(",;\"\n\r\t#") == std::string::npos &&
                          (cell.empty() || (cell.front() != ' ' && cell.back() != ' '));
    if (!is_plain) line += '"';
    for (const char c : cell) line += c == '"' ? std::string("\"\"") : std::string(1, c);
    if (!is_plain) line += '"';
  }
  return line;
}

bool is_formula(std::string_view text) {
  return !text.empty() && std::string_view("=+-@").find(text.front()) != std::string_view::npos;
}

std::string spreadsheet_cell(std::string_view text) {
  return (is_formula(text) ? "'" : "") + printable(text);
}

}  // namespace slipfit
