#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/cells.hpp"
#include "io/names.hpp"

namespace slipfit::reading {

/// A column as the first rows show it.
struct Column {
  ColumnName name;
  std::size_t numbers = 0;
  std::size_t clocks = 0;
  std::size_t missing = 0;  ///< blank, nan, ...
  std::size_t texts = 0;
  bool varies = false;
  bool never_decreases = false;  ///< of at least 3 numbers, and varies
  bool is_regular = false;       ///< never_decreases, in steps that are all alike
  bool is_whole = false;         ///< whole numbers only
  double first = 0.0;
  double median_step = 0.0;
  std::string tag;             ///< text that follows most numbers
  std::vector<double> values;  ///< of every row looked at; NaN where it holds no number

  [[nodiscard]] bool is_numeric() const { return numbers + clocks > 0 && numbers + clocks >= texts; }
  /// Returns true if the column contains no text: it may be a column of missing readings.
  [[nodiscard]] bool may_be_numeric() const { return is_numeric() || (texts == 0 && missing > 0); }
};

/// The layout of the text, detected from its first part.
struct Layout {
  Dialect dialect;
  std::vector<Column> columns;
  std::size_t first_data_line = 1;       ///< 1-based
  std::size_t skipped_lines = 0;         ///< text before the data that is neither names nor units
  std::vector<std::size_t> unread_rows;  ///< 1-based lines before the data that look like rows of it
  bool has_names = false;
  std::string names_line;  ///< as in the file: it is repeated above a further part of the data
  std::size_t rows = 0;    ///< looked at
  double mean_line_length = 0.0;
};

std::vector<std::string_view> split_lines(std::string_view text);

/// Returns true if the comma is both column separator and decimal sign: "0,001,0,51" below two names.
bool is_comma_twice(const std::vector<std::string_view>& lines, const Layout& layout);

/// Returns the layout, or nothing if the lines contain no rows of numbers.
std::optional<Layout> find_layout(const std::vector<std::string_view>& lines);

}  // namespace slipfit::reading
