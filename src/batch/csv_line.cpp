#include "batch/csv_line.hpp"

#include <string_view>

namespace slipfit::batch {
namespace {

std::string in_quotes(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

}  // namespace

std::string csv_line(const std::vector<std::string>& cells) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i > 0) line += ',';
    const std::string& cell = cells[i];
    const bool is_plain = cell.find_first_of(",;\"\n\r\t#") == std::string::npos &&
                          (cell.empty() || (cell.front() != ' ' && cell.back() != ' '));
    line += is_plain ? cell : in_quotes(cell);
  }
  return line;
}

std::string text_cell(const std::string& text) {
  const bool runs = !text.empty() && std::string_view("=+-@").find(text.front()) != std::string_view::npos;
  return runs ? "'" + text : text;
}

}  // namespace slipfit::batch
