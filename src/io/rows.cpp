#include "io/rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "core/word_list.hpp"
#include "io/cells.hpp"
#include "io/text_lines.hpp"

namespace slipfit::reading {
namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();
constexpr double kDay_s = 86400.0;

/// A column besides time and force: where it is chosen, and where its values are kept.
struct SideColumn {
  std::optional<Channel> Choice::*channel = nullptr;
  std::vector<double> Rows::*values = nullptr;
  bool is_magnitude = false;  ///< without sign
};
constexpr std::array<SideColumn, 4> kSideColumns{{{&Choice::displacement, &Rows::displacement_m, false},
                                                  {&Choice::normal_force, &Rows::normal_force_N, true},
                                                  {&Choice::speed, &Rows::speed_m_per_s, true},
                                                  {&Choice::step, &Rows::step, false}}};

/// The values that may be read from a line. That of `kWhereSlot` is compared, not kept; from `kSideSlot` on follow
/// those of kSideColumns.
enum Slot : std::size_t { kTimeSlot, kForceSlot, kWhereSlot, kSideSlot, kSlotCount = kSideSlot + kSideColumns.size() };

/// The numbers of a line; NaN where there is none. There is one for all lines: a copy of what was just written stalls.
struct Reading {
  std::array<double, kSlotCount> values{};
  bool is_wanted = true;  ///< by --where
};

struct WantedColumn {
  std::size_t column = 0;
  std::size_t slot = kTimeSlot;
  double scale = 1.0;  ///< to SI
};

/// In the order of the columns.
std::vector<WantedColumn> wanted_columns(const Choice& choice) {
  std::vector<WantedColumn> wanted;
  const auto add = [&](const std::optional<Channel>& channel, std::size_t slot) {
    if (channel) wanted.push_back({channel->column, slot, channel->scale});
  };
  add(choice.force, kForceSlot);
  add(choice.time, kTimeSlot);
  for (std::size_t i = 0; i < kSideColumns.size(); ++i) add(choice.*kSideColumns[i].channel, kSideSlot + i);
  if (choice.where) wanted.push_back({choice.where->column, kWhereSlot});
  std::ranges::stable_sort(wanted, [](const WantedColumn& a, const WantedColumn& b) { return a.column < b.column; });
  return wanted;
}

std::size_t expected_rows(const TextSource& source, const Layout& layout, const ReadOptions& options) {
  constexpr std::size_t kMost = std::size_t{1} << 27U;
  if (options.window || options.rows || options.where) return 0;
  return std::min(kMost, static_cast<std::size_t>(1.02 * static_cast<double>(source.estimated_size()) /
                                                  std::max(1.0, layout.mean_line_length)));
}

class RowReader {
 public:
  RowReader(const Layout& layout, const Choice& choice, const ReadOptions& options, std::size_t expected_rows)
      : layout_(layout),
        choice_(choice),
        wanted_rows_(options.rows),
        window_(options.step ? std::nullopt : options.window),
        sample_rate_Hz_(options.sample_rate_Hz.value_or(1.0)),
        dialect_(layout.dialect),
        wanted_(wanted_columns(choice)),
        is_clock_(choice.time && choice.time->is_clock) {
    reading_.values.fill(kNoValue);
    rows_.time_s.reserve(expected_rows);
    rows_.force.reserve(expected_rows);
  }

  void add(const char* line, unsigned number) {
    read_plain(line);
    cells_.clear();
    if (!is_complete()) {
      split(line, dialect_, cells_);
      for (const WantedColumn& wanted : wanted_) reading_.values[wanted.slot] = number_at(wanted.column);
      if (!is_complete() && !is_row()) return count_text_line(line, number);
    }
    ++rows_.count;
    if (wanted_rows_ && (rows_.count < wanted_rows_->first || rows_.count > wanted_rows_->last)) return;
    if (!reading_.is_wanted) return;
    turn_into_SI();
    keep(number);
  }

  Rows finish() {
    if (low_s_ <= high_s_) rows_.clock = TimeWindow{low_s_, high_s_};
    const std::size_t seen = rows_.time_s.size() + rows_.without_number + rows_.text_lines;
    if (auto unread = unread_.most(); unread && 10 * unread->count > seen) rows_.unread = std::move(unread);
    return std::move(rows_);
  }

 private:
  [[nodiscard]] bool has_clock() const { return choice_.time.has_value(); }
  [[nodiscard]] bool is_complete() const {
    return (std::isfinite(reading_.values[kTimeSlot]) || !has_clock()) && std::isfinite(reading_.values[kForceSlot]);
  }
  void read_plain(const char* cell);
  [[nodiscard]] bool is_where(std::string_view cell, double number) const;
  [[nodiscard]] double number_at(std::size_t column) const;
  [[nodiscard]] bool is_row() const;
  void turn_into_SI();
  void count_text_line(std::string_view line, unsigned number);
  void count_unread(unsigned number);
  void keep(unsigned number);
  void note_place(unsigned line);

  const Layout& layout_;
  const Choice& choice_;
  std::optional<RowRange> wanted_rows_;
  std::optional<TimeWindow> window_;  ///< the steps are counted over the whole file: of one the window is cut later
  double sample_rate_Hz_;             ///< the clock where no time column is chosen
  Dialect dialect_;
  std::vector<WantedColumn> wanted_;
  bool is_clock_;  ///< h:min:s, which begins again at midnight
  double midnights_s_ = 0.0;
  double last_clock_s_ = -std::numeric_limits<double>::infinity();
  double low_s_ = std::numeric_limits<double>::infinity();
  double high_s_ = -std::numeric_limits<double>::infinity();
  std::size_t counted_ = 0;
  Reading reading_;
  std::vector<std::string_view> cells_;  ///< of a line that is not plain, else empty
  UnreadCellCount unread_;
  Rows rows_;
};

/// Nearly all lines of a recording: what is wanted are plain numbers. NaN where a cell holds anything else. Reads a
/// number and finds the end of its cell in one go.
void RowReader::read_plain(const char* cell) {
  const char point = dialect_.decimal_comma ? ',' : '.';
  for (const WantedColumn& wanted : wanted_) reading_.values[wanted.slot] = kNoValue;
  reading_.is_wanted = true;
  const WantedColumn* wanted = wanted_.data();
  const WantedColumn* const last = wanted + wanted_.size();
  for (std::size_t column = 0;; ++column) {
    if (dialect_.delimiter == ' ') {
      while (*cell == ' ' || *cell == '\t') ++cell;
    }
    const char* const begin = cell;
    if (column != wanted->column) {
      cell = end_of_cell(cell, nullptr, dialect_);
    } else {
      const Decimal number = read_decimal(cell, nullptr, point);
      const bool is_whole = number.is_number && (*number.end == dialect_.delimiter || *number.end == '\0');
      cell = is_whole ? number.end : end_of_cell(cell, nullptr, dialect_);
      const std::string_view text(begin, static_cast<std::size_t>(cell - begin));
      const double value = is_whole ? number.value : plain_number(text, dialect_.decimal_comma);
      for (; wanted != last && wanted->column == column; ++wanted) {
        reading_.values[wanted->slot] = value;
        if (wanted->slot == kWhereSlot) reading_.is_wanted = is_where(text, value);
      }
    }
    if (wanted == last) return;
    if (*cell++ == '\0') break;
  }
  reading_.is_wanted = reading_.is_wanted && !choice_.where;  // its cell was not reached
}

bool RowReader::is_where(std::string_view cell, double number) const {
  const WhereFilter& where = *choice_.where;
  return (where.number && number == *where.number) || unquote(cell) == std::string_view(where.text);
}

/// NaN where the cell holds no number, or one with another tag than this column's ("3 cells ready" among "1.79 N1").
double RowReader::number_at(std::size_t column) const {
  if (column >= cells_.size()) return kNoValue;
  const Column& described = layout_.columns[column];
  const Cell cell = read_cell(cells_[column], dialect_.decimal_comma);
  const bool is_number = cell.kind == CellKind::Number && (cell.tag.empty() || cell.tag == described.tag);
  const bool is_clock = cell.kind == CellKind::Clock && described.clocks > described.numbers;
  return is_number || is_clock ? cell.value : kNoValue;
}

/// An incomplete line is a row when something in it is a number or says that a reading is missing.
bool RowReader::is_row() const {
  for (std::size_t c = 0; c < std::min(cells_.size(), layout_.columns.size()); ++c) {
    const bool is_wanted = c == choice_.force.column || (has_clock() && c == choice_.time->column);
    if (is_wanted && read_cell(cells_[c], dialect_.decimal_comma).kind == CellKind::Missing) return true;
    if (std::isfinite(number_at(c))) return true;
  }
  return false;
}

/// Lines of nothing but blanks and delimiters (spreadsheets leave them at the end) do not count.
void RowReader::count_text_line(std::string_view line, unsigned number) {
  const char delimiter = dialect_.delimiter == '\0' ? ' ' : dialect_.delimiter;
  if (std::ranges::all_of(line, [&](char c) { return c == delimiter || trim({&c, 1}).empty(); })) return;
  if (rows_.text_lines++ == 0) rows_.first_text_line = number;
  const bool is_in_rows = !wanted_rows_ || (rows_.count + 1 >= wanted_rows_->first && rows_.count < wanted_rows_->last);
  if (is_in_rows && reading_.is_wanted) count_unread(number);
  const bool is_names = !layout_.names_line.empty() && trim(line) == layout_.names_line;
  if (is_names && !rows_.time_s.empty()) rows_.blocks.push_back(rows_.time_s.size());
}

/// The cells that cost this line its sample.
void RowReader::count_unread(unsigned number) {
  for (const WantedColumn& wanted : wanted_) {
    if ((wanted.slot != kTimeSlot && wanted.slot != kForceSlot) || wanted.column >= cells_.size()) continue;
    const std::string_view cell = cells_[wanted.column];
    if (read_cell(cell, dialect_.decimal_comma).kind == CellKind::Text) unread_.add(cell, wanted.column, number);
  }
}

void RowReader::turn_into_SI() {
  for (const WantedColumn& wanted : wanted_) reading_.values[wanted.slot] *= wanted.scale;
  double& time_s = reading_.values[kTimeSlot];
  if (!has_clock()) {
    time_s = static_cast<double>(counted_++) / sample_rate_Hz_;
  } else if (is_clock_ && std::isfinite(time_s)) {
    const bool is_date = time_s > 1000.0 * kDay_s;
    if (is_date && !std::isfinite(last_clock_s_)) midnights_s_ = -kDay_s * std::floor(time_s / kDay_s);
    if (!is_date && time_s < last_clock_s_ - kDay_s / 2.0) midnights_s_ += kDay_s;
    last_clock_s_ = time_s;
    time_s += midnights_s_;
  }
}

void RowReader::keep(unsigned number) {
  const std::array<double, kSlotCount>& values = reading_.values;
  const double time_s = values[kTimeSlot];
  if (window_ && std::isfinite(time_s)) {
    low_s_ = std::min(low_s_, time_s);
    high_s_ = std::max(high_s_, time_s);
    if (time_s < window_->begin_s || time_s > window_->end_s) return;
  }
  if (!std::isfinite(time_s) || !std::isfinite(values[kForceSlot])) {
    ++rows_.without_number;
    count_unread(number);
    return;
  }
  note_place(number);
  rows_.time_s.push_back(time_s);
  rows_.force.push_back(values[kForceSlot]);
  for (std::size_t i = 0; i < kSideColumns.size(); ++i) {
    const SideColumn& side = kSideColumns[i];
    if (!(choice_.*side.channel)) continue;
    const double value = values[kSideSlot + i];
    (rows_.*side.values).push_back(side.is_magnitude ? std::abs(value) : value);
  }
}

void RowReader::note_place(unsigned line) {
  const std::size_t sample = rows_.time_s.size();
  if (!rows_.places.empty()) {
    const RowPlace& last = rows_.places.back();
    const std::size_t since = sample - last.sample;
    if (rows_.count - last.row == since && line - last.line == since) return;
  }
  rows_.places.push_back({sample, rows_.count, line});
}

/// Every vector of the samples; those without a column stay empty.
template <class Change>
void for_each_column(Rows& rows, const Change& change) {
  change(rows.time_s);
  change(rows.force);
  for (const SideColumn& side : kSideColumns) {
    if (!(rows.*side.values).empty()) change(rows.*side.values);
  }
}

}  // namespace

RowPlace Rows::place_of(std::size_t sample) const {
  const auto next = std::upper_bound(places.begin(), places.end(), sample,
                                     [](std::size_t s, const RowPlace& place) { return s < place.sample; });
  if (next == places.begin()) return {sample, sample + 1, 1};
  const RowPlace& place = *std::prev(next);
  const std::size_t since = sample - place.sample;
  return {sample, place.row + since, place.line + static_cast<unsigned>(since)};
}

void Rows::cut(const SampleRange& kept) {
  const std::size_t begin = kept.begin;
  const std::size_t end = kept.end;
  if (begin == 0 && end == time_s.size()) return;
  const RowPlace first = place_of(begin);
  std::erase_if(places, [&](const RowPlace& place) { return place.sample <= begin || place.sample >= end; });
  for (RowPlace& place : places) place.sample -= begin;
  places.insert(places.begin(), {0, first.row, first.line});
  std::erase_if(blocks, [&](std::size_t block) { return block <= begin || block >= end; });
  for (std::size_t& block : blocks) block -= begin;
  for_each_column(*this, [&](std::vector<double>& column) {
    column.erase(column.begin() + static_cast<std::ptrdiff_t>(end), column.end());
    column.erase(column.begin(), column.begin() + static_cast<std::ptrdiff_t>(begin));
  });
}

void Rows::keep(const std::vector<std::size_t>& samples) {
  for_each_column(*this, [&](std::vector<double>& column) {
    for (std::size_t i = 0; i < samples.size(); ++i) column[i] = column[samples[i]];
    column.resize(samples.size());
  });
}

void Rows::keep_wanted(const std::optional<RowRange>& wanted_rows, const std::optional<TimeWindow>& window) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    if (wanted_rows && (i + 1 < wanted_rows->first || i + 1 > wanted_rows->last)) continue;
    if (window && std::isfinite(time_s[i])) {
      const TimeWindow known = clock.value_or(TimeWindow{time_s[i], time_s[i]});
      clock = TimeWindow{std::min(known.begin_s, time_s[i]), std::max(known.end_s, time_s[i])};
      if (time_s[i] < window->begin_s || time_s[i] > window->end_s) continue;
    }
    const bool is_number = std::isfinite(time_s[i]) && std::isfinite(force[i]);
    if (is_number) kept.push_back(i);
    without_number += is_number ? 0U : 1U;
  }
  if (kept.size() < time_s.size()) keep(kept);
}

Rows read_rows(std::unique_ptr<TextSource> source, const Layout& layout, const Choice& choice,
               const ReadOptions& options) {
  RowReader reader(layout, choice, options, expected_rows(*source, layout, options));
  const std::shared_ptr<const Digester> digester = source->digester();
  TextLines lines(std::move(source));
  while (const char* line = lines.next()) {
    if (lines.number() >= layout.first_data_line) reader.add(line, lines.number());
  }
  Rows rows = reader.finish();
  rows.digest = digester->digest();
  rows.bytes = digester->bytes();
  return rows;
}

}  // namespace slipfit::reading
