#include "io/layout.hpp"

#include <algorithm>
#include <array>
#include <boost/sort/pdqsort/pdqsort.hpp>
#include <cctype>
#include <cmath>
#include <map>

#include "core/word_list.hpp"
#include "io/cells.hpp"

namespace slipfit::reading {

namespace {

using Lines = std::vector<std::string_view>;

constexpr std::size_t kLinesTried = 256;  // a dozen dialects on each cost under a millisecond

// In the order of preference where two explain the lines equally well.
constexpr std::array kDialects = std::to_array<Dialect>({{',', false},
                                                         {',', false, true},
                                                         {';', false},
                                                         {'\t', false},
                                                         {'|', false},
                                                         {' ', false},
                                                         {'\0', false},
                                                         {';', true},
                                                         {'\t', true},
                                                         {'|', true},
                                                         {' ', true},
                                                         {'\0', true},
                                                         {',', true}});

struct Score {
  double weight = 0.0;
  std::size_t columns = 0;
};

/// "005": after a clock these are its decimals, and no column.
bool has_zero_in_front(std::string_view cell) {
  cell = unquote(cell);
  return cell.size() > 1 && cell[0] == '0' && is_digit(cell[1]);
}

/// Returns how much of a row is understood: 1 if every column is, little if one is not, 0 without a number. Dates and
/// missing readings are understood but are not numbers. Blank cells count a little: "6,<tab>1," has two columns of
/// numbers, not three of which the last is blank in some rows.
double row_weight(const std::vector<std::string_view>& cells, bool decimal_comma) {
  constexpr double kBlank = 0.05;
  double numbers = 0.0;
  double texts = 0.0;
  double blanks = 0.0;
  CellKind before = CellKind::Text;
  for (const std::string_view text : cells) {
    CellKind kind = read_cell(text, decimal_comma).kind;
    if (kind == CellKind::Number && before == CellKind::Clock && has_zero_in_front(text)) kind = CellKind::Text;
    numbers += kind == CellKind::Number || kind == CellKind::Clock ? 1.0 : 0.0;
    texts += kind == CellKind::Text ? 1.0 : 0.0;
    blanks += kind == CellKind::Blank ? 1.0 : 0.0;
    before = kind;
  }
  if (numbers == 0.0) return 0.0;
  const auto columns = static_cast<double>(cells.size());
  const double part = numbers / columns;
  return texts == 0.0 ? 1.0 - kBlank * blanks / columns : 0.25 * part * part;
}

/// Nothing as soon as `least` is out of reach: a line adds 1 at most.
Score score(const std::vector<std::string_view>& lines, const Dialect& dialect, double least) {
  std::map<std::size_t, double> weight_by_columns;
  std::vector<std::string_view> cells;
  double most = 0.0;
  auto left = static_cast<double>(lines.size());
  for (const std::string_view line : lines) {
    split(line, dialect, cells);
    double& weight = weight_by_columns[cells.size()];
    weight += row_weight(cells, dialect.decimal_comma);
    most = std::max(most, weight);
    left -= 1.0;
    if (most + left < least) return {};
  }
  Score best;
  for (const auto& [columns, weight] : weight_by_columns) {
    if (weight > best.weight) best = {weight, columns};
  }
  return best;
}

/// A comma between digits may be all that a decimal comma needs; between columns it needs a quote or another sign
/// beside it.
bool is_worth_trying(const Dialect& dialect, std::string_view all) {
  const auto holds = [&](char c) { return all.find(c) != std::string_view::npos; };
  if (dialect.decimal_comma && !holds(',')) return false;
  if (dialect.comma_in_clock && !holds(':')) return false;
  if (dialect.delimiter == ',' && dialect.decimal_comma) return holds('"');
  if (dialect.delimiter == ' ') return holds(' ') || holds('\t');
  return dialect.delimiter == '\0' || holds(dialect.delimiter);
}

bool is_one_number(std::string_view line) {
  return read_cell(line, true).kind == CellKind::Number;
}

/// "0,51" below a single name ("Kraft [N]") is one number, not two columns.
bool is_single_column(const std::vector<std::string_view>& lines) {
  for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
    if (!is_one_number(lines[i + 1])) continue;
    const ColumnName name = read_name(lines[i], {});
    return lines[i].find(',') == std::string_view::npos && (name.role != Role::Unknown || !name.unit.empty());
  }
  return false;
}

/// Lines to judge by: of those that hold a digit the last ones, and some spread over the rest (which may be console
/// text).
std::vector<std::string_view> choose_samples(const std::vector<std::string_view>& lines) {
  std::vector<std::string_view> with_digit;
  for (const std::string_view line : lines) {
    if (line.find_first_of("0123456789") != std::string_view::npos) with_digit.push_back(line);
  }
  const std::size_t last = with_digit.size() - std::min(with_digit.size(), kLinesTried / 2);
  const std::size_t stride = 1 + 2 * last / kLinesTried;
  std::vector<std::string_view> chosen;
  for (std::size_t i = 0; i < last; i += stride) chosen.push_back(with_digit[i]);
  chosen.insert(chosen.end(), with_digit.begin() + static_cast<std::ptrdiff_t>(last), with_digit.end());
  return chosen;
}

/// The dialect under which most of the lines are rows of numbers; nothing where none makes any.
std::optional<Dialect> find_dialect(const std::vector<std::string_view>& lines) {
  const auto tried = choose_samples(lines);
  std::string all;
  for (const std::string_view line : tried) all.append(line);
  std::optional<Dialect> best;
  Score best_score;
  for (const Dialect& dialect : kDialects) {
    if (!is_worth_trying(dialect, all)) continue;
    const double equal_weight = best_score.weight * 0.999;
    const Score found = score(tried, dialect, equal_weight);
    const bool is_better = found.weight > best_score.weight * 1.001;
    const bool is_equal = found.weight > 0.0 && found.weight >= equal_weight;
    if (!is_better && !(is_equal && found.columns > best_score.columns)) continue;
    best = dialect;
    best_score = found;
  }
  const bool are_pairs = best && best->delimiter == ',' && !best->decimal_comma && best_score.columns == 2;
  if (are_pairs && std::ranges::any_of(tried, is_one_number) && is_single_column(lines)) {
    return Dialect{'\0', true};
  }
  return best;
}

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

/// The names row and the units row above the data, as cells; empty where there is none.
struct Header {
  std::vector<std::string_view> names;
  std::vector<std::string_view> units;
  std::string_view line;  ///< that of the names, else that of the units
  std::size_t lines = 0;
};

/// Looks at the two lines above line `data` (an index into `lines`) that hold a letter, a digit or a percent sign.
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

constexpr std::size_t kEnough = 1000;  // rows to know a column by
constexpr std::size_t kRun = 3;  // so many rows one after the other are data; a single one may be a console message

/// The cells of one line; its memory serves the next.
struct Row {
  std::vector<std::string_view> texts;
  std::vector<Cell> cells;
  bool has_number = false;
  bool has_text = false;

  void read(std::string_view line, const Dialect& dialect) {
    split(line, dialect, texts);
    cells.clear();
    has_number = has_text = false;
    for (const std::string_view text : texts) {
      cells.push_back(read_cell(text, dialect.decimal_comma));
      const CellKind kind = cells.back().kind;
      has_number = has_number || kind == CellKind::Number || kind == CellKind::Clock;
      has_text = has_text || kind == CellKind::Text;
    }
  }
};

/// The usual number of cells, and which of them usually hold numbers.
struct Shape {
  std::size_t columns = 0;
  std::vector<bool> is_number;
};

Shape find_shape(const Lines& lines, const Dialect& dialect) {
  std::map<std::size_t, std::pair<std::size_t, std::vector<std::size_t>>> by_columns;
  Row row;
  for (const std::string_view line : choose_samples(lines)) {
    row.read(line, dialect);
    if (!row.has_number) continue;
    auto& [rows, numbers] = by_columns[row.cells.size()];
    const std::size_t weight = row.has_text ? 1 : 4;  // "Speed;10" above the data is a row of text and number
    rows += weight;
    numbers.resize(row.cells.size());
    for (std::size_t c = 0; c < row.cells.size(); ++c) numbers[c] += row.cells[c].kind == CellKind::Text ? 0U : weight;
  }
  Shape shape;
  std::size_t most = 0;
  for (const auto& [columns, counts] : by_columns) {
    if (counts.first < most) continue;
    most = counts.first;
    shape.columns = columns;
    shape.is_number.assign(columns, false);
    for (std::size_t c = 0; c < columns; ++c) shape.is_number[c] = counts.second[c] * 2 >= counts.first;
  }
  return shape;
}

bool fits(const Row& row, const Shape& shape) {
  if (!row.has_number || row.cells.size() != shape.columns) return false;
  for (std::size_t c = 0; c < shape.columns; ++c) {
    if (shape.is_number[c] && row.cells[c].kind == CellKind::Text) return false;
  }
  return true;
}

/// Index of the line where rows begin to follow each other.
std::optional<std::size_t> find_data(const Lines& lines, const Dialect& dialect, const Shape& shape) {
  std::optional<std::size_t> single;
  std::size_t begin = 0;
  std::size_t run = 0;
  Row row;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (trim(lines[i]).empty()) continue;
    row.read(lines[i], dialect);
    if (!fits(row, shape)) {
      if (row.has_number || row.has_text) run = 0;  // a row of missing readings ends no run
      continue;
    }
    if (run == 0) begin = i;
    if (!single) single = i;
    if (++run == kRun) return begin;
  }
  return run > 0 && run < kRun ? std::optional(begin) : single;
}

/// "6x7", "1.2.3": nothing but signs of numbers, dates and clocks, and yet none of these.
bool is_broken_number(std::string_view text) {
  text = unquote(text);
  return text.find_first_not_of("0123456789.,:/+-eE") == std::string_view::npos;
}

/// Lines above the data, counted from 1, that differ from its rows in a broken number alone; and all lines of numbers
/// with as many cells where there are more of them than any preamble has.
std::vector<std::size_t> find_unread_rows(const Lines& lines, std::size_t data, const Dialect& dialect,
                                          const Shape& shape) {
  constexpr std::size_t kLongestPreamble = 100;
  std::vector<std::size_t> broken;
  std::vector<std::size_t> alike;
  Row row;
  for (std::size_t i = 0; i < data && shape.columns > 1; ++i) {
    row.read(lines[i], dialect);
    if (!row.has_number || row.cells.size() != shape.columns) continue;
    alike.push_back(i + 1);
    bool is_broken = true;
    for (std::size_t c = 0; c < shape.columns; ++c) {
      const bool is_text = shape.is_number[c] && row.cells[c].kind == CellKind::Text;
      is_broken = is_broken && (!is_text || is_broken_number(row.texts[c]));
    }
    if (is_broken) broken.push_back(i + 1);
  }
  return alike.size() > kLongestPreamble ? alike : broken;
}

/// Gathers what the rows say about one column.
class ColumnScan {
 public:
  void add(const Cell& cell) {
    if (cell.kind == CellKind::Text) ++column_.texts;
    if (cell.kind == CellKind::Blank || cell.kind == CellKind::Missing) ++column_.missing;
    column_.values.push_back(cell.value);
    if (cell.kind != CellKind::Number && cell.kind != CellKind::Clock) return;
    ++(cell.kind == CellKind::Number ? column_.numbers : column_.clocks);
    if (!cell.tag.empty()) ++tags_[std::string(cell.tag)];
    values_.push_back(cell.value);
  }

  Column finish(ColumnName name) {
    column_.name = std::move(name);
    for (const auto& [tag, count] : tags_) {
      if (2 * count > values_.size()) column_.tag = tag;
    }
    if (values_.empty()) return column_;
    column_.first = values_.front();
    column_.is_whole = std::ranges::all_of(values_, [](double v) { return v == std::floor(v); });
    std::vector<double> steps;
    for (std::size_t i = 1; i < values_.size(); ++i) steps.push_back(values_[i] - values_[i - 1]);
    if (!steps.empty()) describe_steps(steps);
    return column_;
  }

 private:
  void describe_steps(std::vector<double>& steps) {
    boost::sort::pdqsort_branchless(steps.begin(), steps.end());
    column_.varies = steps.front() != 0.0 || steps.back() != 0.0;
    column_.never_decreases = column_.varies && steps.front() >= 0.0 && steps.size() >= 2;
    const auto rising = std::upper_bound(steps.begin(), steps.end(), 0.0);
    if (rising != steps.end()) column_.median_step = *(rising + (steps.end() - rising) / 2);
    column_.is_regular = column_.never_decreases && steps.front() >= 0.5 * column_.median_step &&
                         steps.back() <= 1.5 * column_.median_step;
  }

  Column column_;
  std::vector<double> values_;
  std::map<std::string, std::size_t> tags_;
};

std::string_view at(const std::vector<std::string_view>& cells, std::size_t i) {
  return i < cells.size() ? cells[i] : std::string_view{};
}

}  // namespace

std::vector<std::string_view> split_lines(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const auto end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    lines.push_back(line);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

bool is_comma_twice(const std::vector<std::string_view>& lines, const Layout& layout) {
  const std::size_t columns = layout.columns.size();
  const bool are_whole = std::ranges::all_of(
      layout.columns, [](const Column& column) { return column.is_whole && column.clocks == 0 && column.texts == 0; });
  if (layout.dialect.delimiter != ',' || layout.dialect.decimal_comma || !are_whole || columns < 3) return false;
  bool has_zero = false;  // "001" is no whole number that anybody writes
  for (std::size_t i = layout.first_data_line - 1; i < lines.size(); ++i) {
    if (lines[i].find('.') != std::string_view::npos) return false;
    for (const std::string_view cell : split(lines[i], layout.dialect)) {
      has_zero = has_zero || has_zero_in_front(cell);
    }
  }
  std::size_t above = layout.first_data_line - 1;
  while (above > 0 && trim(lines[above - 1]).empty()) --above;
  const std::size_t names = above > 0 ? split(lines[above - 1], layout.dialect).size() : 0;
  return names > 1 && names < columns ? columns == 2 * names || has_zero
                                      : has_zero && names != columns && columns % 2 == 0;
}

std::optional<Layout> find_layout(const Lines& lines) {
  const auto dialect = find_dialect(lines);
  if (!dialect) return std::nullopt;
  const Shape shape = find_shape(lines, *dialect);
  const auto data = find_data(lines, *dialect, shape);
  if (!data) return std::nullopt;
  Layout layout;
  layout.dialect = *dialect;
  layout.first_data_line = *data + 1;
  const Header header = find_header(lines, *data, *dialect, shape.columns);
  layout.has_names = !header.names.empty();
  layout.names_line = trim(header.line);
  const auto filled = std::count_if(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(*data),
                                    [](std::string_view line) { return !trim(line).empty(); });
  layout.skipped_lines = static_cast<std::size_t>(filled) - header.lines;
  layout.unread_rows = find_unread_rows(lines, *data, *dialect, shape);
  std::vector<ColumnScan> scans(shape.columns);
  double length = 0.0;
  Row row;
  for (std::size_t i = *data; i < lines.size(); ++i) {
    length += static_cast<double>(lines[i].size()) + 1.0;
    if (layout.rows == kEnough) continue;
    row.read(lines[i], *dialect);
    if (!fits(row, shape)) continue;
    ++layout.rows;
    for (std::size_t c = 0; c < shape.columns; ++c) scans[c].add(row.cells[c]);
  }
  layout.mean_line_length = length / static_cast<double>(lines.size() - *data);
  for (std::size_t c = 0; c < shape.columns; ++c) {
    layout.columns.push_back(scans[c].finish(read_name(at(header.names, c), at(header.units, c))));
  }
  return layout;
}

}  // namespace slipfit::reading
