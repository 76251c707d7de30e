#include "slipfit/io/read_options.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "core/unit_text.hpp"
#include "core/word_list.hpp"
#include "io/cells.hpp"
#include "slipfit/core/units.hpp"

namespace slipfit {

std::vector<std::pair<std::string, std::string>> stated_cells(const ReadOptions& options) {
  std::vector<std::pair<std::string, std::string>> cells;
  const auto add = [&](const char* column, const auto& value) {
    if (value) cells.emplace_back(column, fmt::format("{}", *value));
  };
  add("time_column", options.time_column);
  add("force_column", options.force_column);
  add("normal_force_column", options.normal_force_column);
  add("speed_column", options.speed_column);
  add("radius_m", options.radius_m);
  add("time_unit", options.time_unit);
  add("force_unit", options.force_unit);
  add("force_scale", options.force_scale);
  add("sample_rate_Hz", options.sample_rate_Hz);
  add("sheet", options.sheet);
  add("variable", options.variable);
  add("step", options.step);
  if (const auto& rows = options.rows) cells.emplace_back("rows", fmt::format("{}:{}", rows->first, rows->last));
  if (const auto& where = options.where) cells.emplace_back("where", where->column + "=" + where->value);
  if (const auto& part = options.window)
    cells.emplace_back("window_s", fmt::format("{}:{}", part->begin_s, part->end_s));
  switch (options.pieces) {
    case Pieces::One:
      break;
    case Pieces::Strokes:
      cells.emplace_back("strokes", "both");
      break;
    case Pieces::PositiveStrokes:
      cells.emplace_back("strokes", "positive");
      break;
    case Pieces::NegativeStrokes:
      cells.emplace_back("strokes", "negative");
      break;
    case Pieces::Segments:
      cells.emplace_back("segments", "yes");
      break;
  }
  return cells;
}

std::optional<RowRange> parse_row_range(std::string_view text) {
  RowRange rows;
  const char* const end = text.data() + text.size();
  const auto [colon, first_error] = std::from_chars(text.data(), end, rows.first);
  if (first_error != std::errc() || colon == end || *colon != ':') return std::nullopt;
  const auto [stop, last_error] = std::from_chars(colon + 1, end, rows.last);
  const bool is_range = last_error == std::errc() && stop == end && rows.first >= 1 && rows.first < rows.last;
  return is_range ? std::optional(rows) : std::nullopt;
}

std::optional<Pieces> parse_strokes(std::string_view text) {
  if (text.empty() || text == "both") return Pieces::Strokes;
  if (text == "positive") return Pieces::PositiveStrokes;
  return text == "negative" ? std::optional(Pieces::NegativeStrokes) : std::nullopt;
}

std::optional<ForceScale> parse_force_scale(std::string_view text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos) return std::nullopt;
  const std::string_view unit = trim(text.substr(slash + 1));
  const auto force = parse_quantity(text.substr(0, slash), Dimension::Force);
  const auto per = read_unit(unit);
  if (!force || unit.empty() || !(std::abs(force.value()) > 0.0)) return std::nullopt;
  return ForceScale{force.value() / (per ? per->factor : 1.0), std::string(unit)};
}

std::optional<ColumnValue> parse_column_value(std::string_view text) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string_view::npos) return std::nullopt;
  const std::string_view column = trim(text.substr(0, equals));
  const std::string_view value = trim(text.substr(equals + 1));
  if (column.empty() || value.empty()) return std::nullopt;
  return ColumnValue{std::string(column), std::string(value)};
}

}  // namespace slipfit
