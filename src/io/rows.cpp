#include "io/rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "io/short_decimal.hpp"

namespace slipfit::reading {
namespace {

constexpr std::size_t kNoColumn = std::numeric_limits<std::size_t>::max();

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

/// The numbers of a line; NaN where there is none.
struct Reading {
  double time = kNoValue;
  double force = kNoValue;
  double displacement = kNoValue;
};

class RowReader {
 public:
  explicit RowReader(const RowPlan& plan)
      : plan_(plan),
        dialect_(plan.layout.dialect),
        time_column_(column_of(plan.choice.time)),
        force_column_(plan.choice.force.column),
        displacement_column_(column_of(plan.choice.displacement)),
        last_column_(std::max(
            {plan.choice.time ? time_column_ : 0, force_column_, plan.choice.displacement ? displacement_column_ : 0})),
        time_scale_(plan.choice.time ? plan.choice.time->scale : 1.0),
        force_scale_(plan.choice.force.scale),
        displacement_scale_(plan.choice.displacement ? plan.choice.displacement->scale : 1.0) {
    rows_.time_s.reserve(plan.expected_rows);
    rows_.force.reserve(plan.expected_rows);
  }

  void add(const char* line, unsigned number) {
    Reading reading = read_plain(line);
    if (!is_complete(reading)) {
      split(line, dialect_.delimiter, cells_);
      reading.time = number_at(time_column_);
      reading.force = number_at(force_column_);
      if (!is_complete(reading) && !is_row()) return count_text_line(line, number);
    }
    reading.time = has_clock() ? reading.time * time_scale_ : static_cast<double>(counted_++) / *plan_.sample_rate_Hz;
    reading.force *= force_scale_;
    reading.displacement *= displacement_scale_;
    keep(reading, number);
  }

  Rows finish() {
    if (low_s_ <= high_s_) rows_.clock = TimeWindow{low_s_, high_s_};
    return std::move(rows_);
  }

 private:
  static std::size_t column_of(const std::optional<Channel>& channel) { return channel ? channel->column : kNoColumn; }
  [[nodiscard]] bool has_clock() const { return time_column_ != kNoColumn; }
  [[nodiscard]] bool is_complete(const Reading& reading) const {
    return (std::isfinite(reading.time) || !has_clock()) && std::isfinite(reading.force);
  }
  [[nodiscard]] Reading read_plain(const char* cell) const;
  [[nodiscard]] double number_at(std::size_t column) const;
  [[nodiscard]] bool is_row() const;
  void count_text_line(std::string_view line, unsigned number);
  void keep(const Reading& reading, unsigned number);

  const RowPlan& plan_;
  Dialect dialect_;
  std::size_t time_column_;
  std::size_t force_column_;
  std::size_t displacement_column_;
  std::size_t last_column_;
  double time_scale_;
  double force_scale_;
  double displacement_scale_;
  double latest_s_ = -std::numeric_limits<double>::infinity();
  double low_s_ = std::numeric_limits<double>::infinity();
  double high_s_ = -std::numeric_limits<double>::infinity();
  std::size_t counted_ = 0;
  std::vector<std::string_view> cells_;  ///< of a line that is not plain
  Rows rows_;
};

/// Nearly all lines of a recording: what is wanted are plain numbers. NaN where a cell holds anything else. Reads a
/// number and finds the end of its cell in one go.
Reading RowReader::read_plain(const char* cell) const {
  const char point = dialect_.decimal_comma ? ',' : '.';
  Reading reading;
  for (std::size_t column = 0;; ++column) {
    if (dialect_.delimiter == ' ') {
      while (*cell == ' ' || *cell == '\t') ++cell;
    }
    double* const wanted = column == time_column_           ? &reading.time
                           : column == force_column_        ? &reading.force
                           : column == displacement_column_ ? &reading.displacement
                                                            : nullptr;
    const char* const begin = cell;
    if (wanted != nullptr) {
      const ShortDecimal number = read_short_decimal(cell, nullptr, point);
      const bool is_whole = number.is_number && (*number.end == dialect_.delimiter || *number.end == '\0');
      cell = is_whole ? number.end : end_of_cell(cell, nullptr, dialect_.delimiter);
      *wanted = is_whole ? number.value
                         : plain_number({begin, static_cast<std::size_t>(cell - begin)}, dialect_.decimal_comma);
    } else {
      cell = end_of_cell(cell, nullptr, dialect_.delimiter);
    }
    if (column == last_column_ || *cell++ == '\0') return reading;
  }
}

/// NaN where the cell holds no number, or one with another tag than this column's ("3 cells ready" among "1.79 N1").
double RowReader::number_at(std::size_t column) const {
  if (column >= cells_.size()) return kNoValue;
  const Column& described = plan_.layout.columns[column];
  const Cell cell = read_cell(cells_[column], dialect_.decimal_comma);
  const bool is_number = cell.kind == CellKind::Number && (cell.tag.empty() || cell.tag == described.tag);
  const bool is_clock = cell.kind == CellKind::Clock && described.clocks > described.numbers;
  return is_number || is_clock ? cell.value : kNoValue;
}

/// An incomplete line is a row when something in it is a number or says that a reading is missing.
bool RowReader::is_row() const {
  for (std::size_t c = 0; c < std::min(cells_.size(), plan_.layout.columns.size()); ++c) {
    const bool is_wanted = c == force_column_ || c == time_column_;
    if (is_wanted && read_cell(cells_[c], dialect_.decimal_comma).kind == CellKind::Missing) return true;
    if (std::isfinite(number_at(c))) return true;
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
  if (!std::isfinite(reading.time) || !std::isfinite(reading.force)) {
    ++rows_.without_number;
    return;
  }
  if (reading.time < latest_s_) {
    ++rows_.in_window;
    if (rows_.backward++ == 0) rows_.first_backward_line = number;
    return;
  }
  if (reading.time == latest_s_) ++rows_.repeating;
  ++rows_.in_window;
  latest_s_ = reading.time;
  rows_.time_s.push_back(reading.time);
  rows_.force.push_back(reading.force);
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
