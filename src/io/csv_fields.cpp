#include "io/csv_fields.hpp"

#include <algorithm>
#include <cstddef>

#include "io/cells.hpp"

namespace slipfit::reading {
namespace {

/// Takes a quoted field off the front of `rest`; nothing where its quote is not closed.
std::optional<std::string> take_quoted(std::string_view& rest) {
  std::string field;
  for (std::size_t i = 1; i < rest.size(); ++i) {
    if (rest[i] != '"') {
      field += rest[i];
    } else if (i + 1 < rest.size() && rest[i + 1] == '"') {
      field += rest[i++];
    } else {
      rest.remove_prefix(i + 1);
      return field;
    }
  }
  return std::nullopt;
}

/// A tab that is the delimiter is no blank.
std::string_view skip_blanks(std::string_view text, char delimiter) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t') && text.front() != delimiter) {
    text.remove_prefix(1);
  }
  return text;
}

}  // namespace

std::optional<std::vector<std::string>> csv_fields(std::string_view line, char delimiter) {
  std::vector<std::string> fields;
  for (;;) {
    line = skip_blanks(line, delimiter);
    std::optional<std::string> quoted;
    if (!line.empty() && line.front() == '"') {
      quoted = take_quoted(line);
      if (!quoted) return std::nullopt;
    }
    const std::size_t end = std::min(line.find(delimiter), line.size());
    const std::string_view plain = trim(line.substr(0, end));
    if (quoted && !plain.empty()) return std::nullopt;
    fields.push_back(quoted ? *std::move(quoted) : std::string(plain));
    if (end == line.size()) return fields;
    line.remove_prefix(end + 1);
  }
}

}  // namespace slipfit::reading
