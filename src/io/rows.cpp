#include "io/rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "io/short_decimal.hpp"

namespace slipfit::reading {
namespace {

constexpr std::size_t kNoColumn = std::numeric_limits<std::size_t>::max();

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

/// A cell, and its number where it is nothing but one.
struct NumberCell {
  std::string_view text;
  double value = kNoValue;
};

/// The cells of one line that matter; without text where the line ends before them.
struct Wanted {
  NumberCell time;
  NumberCell force;
  NumberCell displacement;
};

struct Reading {
  double time = 0.0;
  double force = 0.0;
  double displacement = kNoValue;  ///< NaN: none

  [[nodiscard]] bool is_complete() const { return std::isfinite(time) && std::isfinite(force); }
};

class RowReader {
 public:
  explicit RowReader(const RowPlan& plan)
      : plan_(plan),
        dialect_(plan.layout.dialect),
        time_column_(plan.choice.time ? plan.choice.time->column : kNoColumn),
        force_column_(plan.choice.force.column),
        displacement_column_(plan.choice.displacement ? plan.choice.displacement->column : kNoColumn),
        last_column_(std::max(
            {plan.choice.time ? time_column_ : 0, force_column_, plan.choice.displacement ? displacement_column_ : 0})),
        may_be_plain_(plan.choice.time && !plan.choice.displacement && dialect_.delimiter != ' '),
        time_scale_(plan.choice.time ? plan.choice.time->scale : 1.0),
        force_scale_(plan.choice.force.scale) {
    rows_.time_s.reserve(plan.expected_rows);
    rows_.force.reserve(plan.expected_rows);
  }

  void add(const char* line, unsigned number) {
    if (may_be_plain_) {
      const Reading plain = read_plain(line);
      if (plain.is_complete() && plain.time > latest_s_ && !plan_.window) return append(plain);
      if (plain.is_complete()) return keep(plain, number);
    }
    add_carefully(line, number);
  }

  Rows finish() {
    if (low_s_ <= high_s_) rows_.clock = TimeWindow{low_s_, high_s_};
    return std::move(rows_);
  }

 private:
  [[nodiscard]] bool has_clock() const { return time_column_ != kNoColumn; }
  [[nodiscard]] Reading read_plain(const char* cell) const;
  void add_carefully(const char* line, unsigned number);
  [[nodiscard]] Wanted locate(const char* line) const;
  [[nodiscard]] NumberCell read_cell_at(const char* cell) const;
  [[nodiscard]] double number_in(std::string_view text, std::size_t column) const;
  [[nodiscard]] Reading read_carefully(const Wanted& wanted) const;
  [[nodiscard]] bool is_row(std::string_view line, const Wanted& wanted) const;
  void count_text_line(std::string_view line, unsigned number);
  void keep(const Reading& reading, unsigned number);
  void append(const Reading& reading) {
    ++rows_.in_window;
    latest_s_ = reading.time;
    rows_.time_s.push_back(reading.time);
    rows_.force.push_back(reading.force);
  }

  double next_count_s() { return static_cast<double>(counted_++) / *plan_.sample_rate_Hz; }

  const RowPlan& plan_;
  Dialect dialect_;
  std::size_t time_column_;
  std::size_t force_column_;
  std::size_t displacement_column_;
  std::size_t last_column_;
  bool may_be_plain_;
  double time_scale_;
  double force_scale_;
  double latest_s_ = -std::numeric_limits<double>::infinity();
  double low_s_ = std::numeric_limits<double>::infinity();
  double high_s_ = -std::numeric_limits<double>::infinity();
  std::size_t counted_ = 0;
  Rows rows_;
};

/// Nearly all lines of a recording: time and force are plain numbers. NaN where anything is not.
Reading RowReader::read_plain(const char* cell) const {
  const char point = dialect_.decimal_comma ? ',' : '.';
  Reading reading{kNoValue, kNoValue};
  for (std::size_t column = 0;; ++column) {
    if (column == time_column_ || column == force_column_) {
      const ShortDecimal number = read_short_decimal(cell, nullptr, point);
      if (!number.is_number || (*number.end != dialect_.delimiter && *number.end != '\0')) return reading;
      if (column == time_column_) reading.time = number.value * time_scale_;
      if (column == force_column_) reading.force = number.value * force_scale_;
      cell = number.end;
    } else {
      cell = end_of_cell(cell, nullptr, dialect_.delimiter);
    }
    if (column == last_column_ || *cell++ == '\0') return reading;
  }
}

void RowReader::add_carefully(const char* line, unsigned number) {
  const Wanted wanted = locate(line);
  Reading reading{has_clock() ? wanted.time.value : 0.0, wanted.force.value};
  if (!reading.is_complete()) reading = read_carefully(wanted);
  if (!reading.is_complete() && !is_row(line, wanted)) {
    count_text_line(line, number);
    return;
  }
  const double time_s = has_clock() ? reading.time * time_scale_ : next_count_s();
  const double displacement =
      plan_.choice.displacement ? wanted.displacement.value * plan_.choice.displacement->scale : kNoValue;
  keep({time_s, reading.force * force_scale_, displacement}, number);
}

/// Reading the number and finding the end of its cell in one go, where the number is a plain one.
NumberCell RowReader::read_cell_at(const char* cell) const {
  const ShortDecimal quick = read_short_decimal(cell, nullptr, dialect_.decimal_comma ? ',' : '.');
  if (quick.is_number && (*quick.end == dialect_.delimiter || *quick.end == '\0')) {
    return {{cell, static_cast<std::size_t>(quick.end - cell)}, quick.value};
  }
  const std::string_view text(cell, static_cast<std::size_t>(end_of_cell(cell, nullptr, dialect_.delimiter) - cell));
  return {text, plain_number(text, dialect_.decimal_comma)};
}

Wanted RowReader::locate(const char* line) const {
  Wanted wanted;
  const char* cell = line;
  for (std::size_t column = 0;; ++column) {
    if (dialect_.delimiter == ' ') {
      while (*cell == ' ' || *cell == '\t') ++cell;
      if (*cell == '\0') return wanted;
    }
    NumberCell* const slot = column == time_column_           ? &wanted.time
                             : column == force_column_        ? &wanted.force
                             : column == displacement_column_ ? &wanted.displacement
                                                              : nullptr;
    if (slot != nullptr) *slot = read_cell_at(cell);
    const char* const end =
        slot != nullptr ? slot->text.data() + slot->text.size() : end_of_cell(cell, nullptr, dialect_.delimiter);
    if (column == last_column_ || *end == '\0') return wanted;
    cell = end + 1;
  }
}

/// NaN where the cell holds no number, or one with another tag than this column's ("3 cells ready" among "1.79 N1").
double RowReader::number_in(std::string_view text, std::size_t column) const {
  const Column& described = plan_.layout.columns[column];
  const Cell cell = read_cell(text, dialect_.decimal_comma);
  const bool is_number = cell.kind == CellKind::Number && (cell.tag.empty() || cell.tag == described.tag);
  const bool is_clock = cell.kind == CellKind::Clock && described.clocks > described.numbers;
  return is_number || is_clock ? cell.value : kNoValue;
}

Reading RowReader::read_carefully(const Wanted& wanted) const {
  return {has_clock() ? number_in(wanted.time.text, time_column_) : 0.0, number_in(wanted.force.text, force_column_)};
}

/// An incomplete line is a row when something in it is a number or says that a reading is missing.
bool RowReader::is_row(std::string_view line, const Wanted& wanted) const {
  const auto says_missing = [&](std::string_view text) {
    return read_cell(text, dialect_.decimal_comma).kind == CellKind::Missing;
  };
  if (says_missing(wanted.force.text) || (has_clock() && says_missing(wanted.time.text))) return true;
  const auto cells = split(line, dialect_.delimiter);
  for (std::size_t c = 0; c < std::min(cells.size(), plan_.layout.columns.size()); ++c) {
    if (std::isfinite(number_in(cells[c], c))) return true;
  }
  return false;
}

/// Lines of nothing but blanks and delimiters (spreadsheets leave them at the end) do not count.
void RowReader::count_text_line(std::string_view line, unsigned number) {
  const char delimiter = dialect_.delimiter == '\0' ? ' ' : dialect_.delimiter;
  if (std::all_of(line.begin(), line.end(), [&](char c) { return c == delimiter || trim({&c, 1}).empty(); })) return;
  if (rows_.text_lines++ == 0) rows_.first_text_line = number;
}

void RowReader::keep(const Reading& reading, unsigned number) {
  if (plan_.window && std::isfinite(reading.time)) {
    low_s_ = std::min(low_s_, reading.time);
    high_s_ = std::max(high_s_, reading.time);
    if (reading.time < plan_.window->begin_s || reading.time > plan_.window->end_s) return;
  }
  if (!reading.is_complete()) {
    ++rows_.without_number;
    return;
  }
  if (reading.time < latest_s_) {
    ++rows_.in_window;
    if (rows_.backward++ == 0) rows_.first_backward_line = number;
    return;
  }
  if (reading.time == latest_s_) ++rows_.repeating;
  append(reading);
  if (std::isfinite(reading.displacement)) rows_.displacement.add({reading.time, reading.displacement});
}

}  // namespace

Rows read_rows(const std::string& file, std::unique_ptr<TextSource> source, const RowPlan& plan) {
  RowReader reader(plan);
  const std::shared_ptr<const Digester> digester = source->digester();
  ::io::LineReader lines(file.c_str(), std::move(source));
  while (const char* line = lines.next_line()) {
    const unsigned number = lines.get_file_line();
    if (number >= plan.layout.first_data_line) reader.add(line, number);
  }
  Rows rows = reader.finish();
  rows.digest = digester->digest();
  rows.bytes = digester->bytes();
  return rows;
}

}  // namespace slipfit::reading
