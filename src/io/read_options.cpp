#include "slipfit/io/read_options.hpp"

#include <charconv>

#include "io/cells.hpp"

namespace slipfit {

std::optional<RowRange> parse_row_range(std::string_view text) {
  RowRange rows;
  const char* const end = text.data() + text.size();
  const auto [colon, first_error] = std::from_chars(text.data(), end, rows.first);
  if (first_error != std::errc() || colon == end || *colon != ':') return std::nullopt;
  const auto [stop, last_error] = std::from_chars(colon + 1, end, rows.last);
  const bool is_range = last_error == std::errc() && stop == end && rows.first >= 1 && rows.first < rows.last;
  return is_range ? std::optional(rows) : std::nullopt;
}

std::optional<ColumnValue> parse_column_value(std::string_view text) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string_view::npos) return std::nullopt;
  const std::string_view column = reading::trim(text.substr(0, equals));
  const std::string_view value = reading::trim(text.substr(equals + 1));
  if (column.empty() || value.empty()) return std::nullopt;
  return ColumnValue{std::string(column), std::string(value)};
}

}  // namespace slipfit
