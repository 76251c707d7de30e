#include "core/word_list.hpp"
#include "io/layout.hpp"

#include <algorithm>
#include <cctype>

namespace slipfit::reading {
namespace {

std::string_view strip_comment(std::string_view line) {
  line = trim(line);
  while (!line.empty() && (line.front() == '#' || line.front() == '%' || line.front() == '!')) line.remove_prefix(1);
  if (line.starts_with("//")) line.remove_prefix(2);
  return trim(line);
}

/// "Time (s)  Force (N)" has two names, not four: brackets belong to the word before them.
std::vector<std::string_view> join_brackets(const std::vector<std::string_view>& cells) {
  std::vector<std::string_view> joined;
  for (const std::string_view cell : cells) {
    const bool is_bracket = cell.front() == '(' || cell.front() == '[' || cell == "/";
    const bool follows_slash = !joined.empty() && joined.back().ends_with("/");
    if (!joined.empty() && (is_bracket || follows_slash)) {
      const char* begin = joined.back().data();
      joined.back() = {begin, static_cast<std::size_t>(cell.data() + cell.size() - begin)};
    } else {
      joined.push_back(cell);
    }
  }
  return joined;
}

/// Columns of words parted by tabs or by two and more blanks.
std::vector<std::string_view> split_wide(std::string_view line) {
  std::vector<std::string_view> cells;
  while (!(line = trim(line)).empty()) {
    const auto end = std::min({line.find("  "), line.find('\t'), line.size()});
    cells.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
  return cells;
}

/// The cells of a line of names or units; empty where no way of splitting gives the columns of the data.
std::vector<std::string_view> split_header(std::string_view line, const Dialect& dialect, std::size_t columns) {
  const bool is_comment = strip_comment(line) != trim(line);
  if (is_comment || dialect.delimiter == ' ') line = strip_comment(line);
  const auto matches = [&](const std::vector<std::string_view>& cells) {
    return cells.size() == columns || (cells.size() + 1 == columns && cells.size() > 1) ||
           (cells.size() == columns + 1 && trim(cells.back()).empty());
  };
  std::vector<std::vector<std::string_view>> ways = {split(line, dialect)};
  if (dialect.delimiter == ' ') ways.push_back(join_brackets(ways.front()));
  if (dialect.delimiter == ' ') ways.push_back(split_wide(line));
  if (columns > 1) {
    for (const char other : {'\t', ';', ','}) ways.push_back(split(line, Dialect{other}));
  }
  for (auto& cells : ways) {
    if (!matches(cells)) continue;
    cells.resize(columns);
    return cells;
  }
  return {};
}

struct CountedUnits {
  std::size_t known = 0;
  std::size_t unknown = 0;
};

CountedUnits count_units(const std::vector<std::string_view>& cells) {
  CountedUnits count;
  for (const std::string_view cell : cells) {
    std::string_view text = unquote(cell);
    const bool in_brackets = text.size() > 2 && (text.front() == '[' || text.front() == '(');
    if (in_brackets) text = trim(text.substr(1, text.size() - 2));
    const UnitClass unit_class = classify_unit(text);
    if (unit_class == UnitClass::None) continue;
    ++(unit_class == UnitClass::NotAUnit && !in_brackets ? count.unknown : count.known);
  }
  return count;
}

bool is_names_row(const std::vector<std::string_view>& cells) {
  if (cells.empty()) return false;
  std::size_t texts = 0;
  for (const std::string_view cell : cells) {
    const CellKind kind = read_cell(cell, false).kind;
    if (kind == CellKind::Number || kind == CellKind::Clock) return false;
    if (kind == CellKind::Text || kind == CellKind::Missing) ++texts;
  }
  if (cells.size() > 1) return texts > 0;
  // Any console text may precede a single column.
  const ColumnName name = read_name(cells.front(), {});
  return texts > 0 && (name.role != Role::Unknown || !name.unit.empty()) && name.text.size() < 40;
}

/// Returns the number of known column names, regardless of units.
std::ptrdiff_t count_known_names(const std::vector<std::string_view>& cells) {
  return std::ranges::count_if(cells, [](std::string_view cell) {
    const Role role = read_name(cell, {}).role;
    return role != Role::Unknown && role != Role::Other;
  });
}

/// Units alone; or a row of names above, and most of them units, or the names known above and unknown here ("s,raw"
/// below "time,force").
bool is_units_row(const std::vector<std::string_view>& cells, const std::vector<std::string_view>& above) {
  const bool has_reading = std::ranges::any_of(cells, [](std::string_view cell) {
    return read_cell(cell, false).kind == CellKind::Number && trim(cell) != "1";
  });
  const CountedUnits count = count_units(cells);
  if (has_reading || count.known == 0) return false;
  if (count.unknown == 0) return true;
  if (!is_names_row(above) || count_units(above).known > count_units(above).unknown) return false;
  return count.known > count.unknown || count_known_names(above) > count_known_names(cells);
}

/// Neither blank nor a rule between header and data.
bool says_something(std::string_view line) {
  return std::ranges::any_of(line, [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return std::isalnum(byte) != 0 || byte >= 0x80 || c == '%';
  });
}

}  // namespace

Header find_header(const std::vector<std::string_view>& lines, std::size_t data, const Dialect& dialect,
                   std::size_t columns) {
  std::vector<std::vector<std::string_view>> above;
  std::vector<std::size_t> places;
  for (std::size_t i = data; i > 0 && above.size() < 2; --i) {
    if (!says_something(lines[i - 1])) continue;
    above.push_back(split_header(lines[i - 1], dialect, columns));
    places.push_back(i - 1);
  }
  above.resize(2);
  Header header;
  if (!above[0].empty() && is_units_row(above[0], above[1])) {
    header.units = above[0];
    header.names = is_names_row(above[1]) ? above[1] : std::vector<std::string_view>{};
    header.lines = header.names.empty() ? 1 : 2;
    if (header.names.empty()) header.names = header.units;  // "s,N" alone names the columns too
  } else if (is_names_row(above[0])) {
    header.names = above[0];
    header.lines = 1;
  }
  if (header.lines > 0) header.line = lines[places[header.lines - 1]];
  return header;
}

}  // namespace slipfit::reading
