#include "io/layout.hpp"
#include "core/word_list.hpp"

#include <algorithm>
#include <boost/sort/pdqsort/pdqsort.hpp>
#include <cmath>
#include <map>

namespace slipfit::reading {
namespace {

using Lines = std::vector<std::string_view>;

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
