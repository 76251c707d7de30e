#include "io/manifest_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>

#include "io/cells.hpp"
#include "io/message.hpp"

namespace slipfit::reading {
namespace {

enum class Range { AboveZero, NotNegative, Any };

struct KnownColumn {
  std::string_view base;
  ManifestField field;
  std::optional<Dimension> dimension;  ///< empty: text
  std::string_view full_name;          ///< with its SI unit, for messages
  Range range = Range::Any;            ///< of a number
};

// A name that begins like another one stands before it.
constexpr std::array kKnownColumns = std::to_array<KnownColumn>({
    {"id", ManifestField::Id, std::nullopt, "id"},
    {"file", ManifestField::File, std::nullopt, "file"},
    {"speed_se", ManifestField::SpeedStandardError, Dimension::Speed, "speed_se_m_per_s", Range::NotNegative},
    {"speed", ManifestField::Speed, Dimension::Speed, "speed_m_per_s", Range::AboveZero},
    {"normal_force", ManifestField::NormalForce, Dimension::Force, "normal_force_N", Range::AboveZero},
    {"zero_force", ManifestField::ZeroForce, Dimension::Force, "zero_force_N"},
    {"force_view", ManifestField::ForceView, std::nullopt, "force_view"},
    {"group", ManifestField::Group, std::nullopt, "group"},
    {"time_column", ManifestField::TimeColumn, std::nullopt, "time_column"},
    {"force_column", ManifestField::ForceColumn, std::nullopt, "force_column"},
    {"time_unit", ManifestField::TimeUnit, std::nullopt, "time_unit"},
    {"force_unit", ManifestField::ForceUnit, std::nullopt, "force_unit"},
    {"sample_rate", ManifestField::SampleRate, Dimension::Frequency, "sample_rate_Hz", Range::AboveZero},
    {"window", ManifestField::Window, Dimension::Time, "window_s"},
    {"measured_spacing", ManifestField::MeasuredSpacing, Dimension::Length, "measured_spacing_m", Range::AboveZero},
});

const KnownColumn& known_column(ManifestField field) {
  return *std::find_if(kKnownColumns.begin(), kKnownColumns.end(),
                       [field](const KnownColumn& column) { return column.field == field; });
}

/// "mm_per_s" is "mm/s".
std::string spelled_out(std::string_view unit) {
  std::string text(unit);
  for (auto at = text.find("_per_"); at != std::string::npos; at = text.find("_per_")) text.replace(at, 5, "/");
  return text;
}

/// What stands behind the base: nothing, "[mm/s]", "(mm/s)" or "_mm_per_s".
struct UnitText {
  std::string unit;
  bool in_brackets = false;
};

std::optional<UnitText> unit_behind(std::string_view name, std::string_view base) {
  const auto same = [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; };
  if (name.size() < base.size() ||
      !std::equal(base.begin(), base.end(), name.begin(), [&](char b, char a) { return same(a, b); })) {
    return std::nullopt;
  }
  const std::string_view rest = trim(name.substr(base.size()));
  if (rest.empty()) return UnitText{};
  if (rest.size() > 2 && ((rest.front() == '[' && rest.back() == ']') || (rest.front() == '(' && rest.back() == ')'))) {
    return UnitText{std::string(trim(rest.substr(1, rest.size() - 2))), true};
  }
  if (rest.front() == '_') return UnitText{spelled_out(rest.substr(1)), false};
  return std::nullopt;
}

/// Nothing where the name is none of ours. Error: unknown_unit, in brackets only ("speed_old" is some other column).
Result<std::optional<ManifestColumn>> recognise(const std::string& name, std::size_t index, const std::string& place) {
  for (const KnownColumn& known : kKnownColumns) {
    const auto unit_text = unit_behind(name, known.base);
    if (!unit_text) continue;
    ManifestColumn column{known.field, index, printable(name), std::nullopt, {}};
    if (unit_text->unit.empty()) return std::optional(column);
    if (!known.dimension) continue;
    const Result<UnitScale> unit = parse_unit(unit_text->unit, *known.dimension);
    if (unit) {
      column.scale = unit.value().scale;
      if (*column.scale != 1.0) column.unit = printable(unit_text->unit);
      return std::optional(column);
    }
    if (unit_text->in_brackets) {
      return Error{"unknown_unit",
                   fmt::format("{}: column '{}': {}", place, column.name, printable(unit.error().message))};
    }
  }
  return std::optional<ManifestColumn>();
}

std::optional<Error> check_needed(const ManifestColumns& columns, const std::string& place) {
  for (const ManifestField needed : {ManifestField::Id, ManifestField::File, ManifestField::Speed}) {
    const bool found = std::any_of(columns.read.begin(), columns.read.end(),
                                   [needed](const ManifestColumn& column) { return column.field == needed; });
    if (found) continue;
    const std::string ignored =
        columns.ignored.empty() ? "" : fmt::format(", not understood: {}", fmt::join(columns.ignored, ", "));
    return Error{"missing_column", fmt::format("{}: there is no column '{}'{}; expected a line of names such as "
                                               "id,file,speed_m_per_s",
                                               place, known_column(needed).full_name, ignored)};
  }
  return std::nullopt;
}

struct CellError {
  std::string code;
  std::string expected;
};

Error cell_error(const ManifestColumn& column, const std::string& cell, const CellError& error) {
  return {error.code,
          fmt::format("column '{}': bad value '{}', expected {}", column.name, printable(cell), error.expected)};
}

/// In SI: plain where the name has a unit, else a number that may bring its own.
Result<double> number_of(const ManifestColumn& column, const std::string& cell, const std::string& text,
                         bool decimal_comma) {
  const KnownColumn& known = known_column(column.field);
  if (!column.scale) {
    Result<double> value = parse_quantity(text, *known.dimension);
    if (value) return value;
    return Error{value.error().code, fmt::format("column '{}': {}", column.name, printable(value.error().message))};
  }
  const Cell number = read_cell(text, decimal_comma && text.find(',') != std::string::npos);
  if (number.kind == CellKind::Number && number.tag.empty()) return number.value * *column.scale;
  return cell_error(column, cell, {"bad_number", "a plain number, in the unit that the column's name gives"});
}

Result<ManifestEntry> with_number(ManifestEntry entry, const ManifestColumn& column, const std::string& cell,
                                  bool decimal_comma) {
  const Result<double> number = number_of(column, cell, cell, decimal_comma);
  if (!number) return number.error();
  const double value = number.value();
  const Range range = known_column(column.field).range;
  if (range == Range::AboveZero && !(value > 0.0))
    return cell_error(column, cell, {"out_of_range", "a number above zero"});
  if (range == Range::NotNegative && value < 0.0) return cell_error(column, cell, {"out_of_range", "zero or more"});
  Conditions& conditions = entry.conditions;
  if (column.field == ManifestField::Speed) {
    conditions.speed_m_per_s = value;
    conditions.speed_unit = column.scale ? column.unit : std::string(unit_in(cell));
  }
  if (column.field == ManifestField::SpeedStandardError) conditions.speed_standard_error_m_per_s = value;
  if (column.field == ManifestField::NormalForce) conditions.normal_force_N = value;
  if (column.field == ManifestField::ZeroForce) conditions.zero_force_N = value;
  if (column.field == ManifestField::MeasuredSpacing) conditions.measured_spacing_m = value;
  if (column.field == ManifestField::SampleRate) entry.options.sample_rate_Hz = value;
  return entry;
}

Result<TimeWindow> window_of(const ManifestColumn& column, const std::string& cell, bool decimal_comma) {
  const CellError wrong{"bad_window", "T0:T1 with T0 < T1, on the recording's own clock"};
  const std::size_t colon = cell.find(':');
  if (colon == std::string::npos) return cell_error(column, cell, wrong);
  const Result<double> begin_s = number_of(column, cell, cell.substr(0, colon), decimal_comma);
  if (!begin_s) return begin_s.error();
  const Result<double> end_s = number_of(column, cell, cell.substr(colon + 1), decimal_comma);
  if (!end_s) return end_s.error();
  if (!(begin_s.value() < end_s.value())) return cell_error(column, cell, wrong);
  return TimeWindow{begin_s.value(), end_s.value()};
}

Result<std::string> id_of(const ManifestColumn& column, const std::string& cell) {
  const bool has_slash = cell.find_first_of("/\\") != std::string::npos;
  const bool has_control =
      std::any_of(cell.begin(), cell.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; });
  if (!has_slash && !has_control && !cell.starts_with("group:")) return to_utf8(cell);
  return cell_error(column, cell,
                    {"bad_id", "a name without slash or control character that does not begin with 'group:'"});
}

Result<ForceView> force_view_of(const ManifestColumn& column, const std::string& cell) {
  if (cell == "spring") return ForceView::Spring;
  if (cell == "transmitted") return ForceView::Transmitted;
  if (cell == "contact") return ForceView::Contact;
  return cell_error(column, cell, {"unknown_force_view", "spring, transmitted or contact"});
}

std::optional<Error> check_unit(const ManifestColumn& column, const std::string& cell) {
  const bool is_time = column.field == ManifestField::TimeUnit;
  if (!is_time && parse_unit(cell, Dimension::Dimensionless)) return std::nullopt;
  const Result<UnitScale> unit = parse_unit(cell, is_time ? Dimension::Time : Dimension::Force);
  if (unit) return std::nullopt;
  return Error{"unknown_unit", fmt::format("column '{}': {}", column.name, printable(unit.error().message))};
}

Result<ManifestEntry> with_plain_text(ManifestEntry entry, ManifestField field, const std::string& text) {
  if (field == ManifestField::File) entry.file = text;
  if (field == ManifestField::Group) entry.group = to_utf8(text);
  if (field == ManifestField::TimeColumn) entry.options.time_column = text;
  if (field == ManifestField::ForceColumn) entry.options.force_column = text;
  if (field == ManifestField::TimeUnit) entry.options.time_unit = text;
  if (field == ManifestField::ForceUnit) entry.options.force_unit = text;
  return entry;
}

}  // namespace

Result<ManifestColumns> find_manifest_columns(const std::vector<std::string>& names, const std::string& place) {
  ManifestColumns columns;
  columns.count = names.size();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto column = recognise(names[i], i, place);
    if (!column) return column.error();
    if (!column.value()) {
      columns.ignored.push_back(printable(names[i]));
      continue;
    }
    for (const ManifestColumn& other : columns.read) {
      if (other.field != column.value()->field) continue;
      return Error{"duplicate_column", fmt::format("{}: the columns '{}' and '{}' say the same, expected one of them",
                                                   place, other.name, column.value()->name)};
    }
    columns.read.push_back(*column.value());
  }
  if (const auto error = check_needed(columns, place)) return *error;
  return columns;
}

Result<ManifestEntry> with_cell(ManifestEntry entry, const ManifestColumn& column, const std::string& cell,
                                bool decimal_comma) {
  if (column.field == ManifestField::Id) {
    auto id = id_of(column, cell);
    if (!id) return id.error();
    entry.id = std::move(id).value();
    return entry;
  }
  if (column.field == ManifestField::ForceView) {
    const auto view = force_view_of(column, cell);
    if (!view) return view.error();
    entry.conditions.force_view = view.value();
    return entry;
  }
  if (column.field == ManifestField::Window) {
    const auto window = window_of(column, cell, decimal_comma);
    if (!window) return window.error();
    entry.options.window = window.value();
    return entry;
  }
  if (known_column(column.field).dimension) return with_number(std::move(entry), column, cell, decimal_comma);
  if (column.field == ManifestField::TimeUnit || column.field == ManifestField::ForceUnit) {
    if (const auto error = check_unit(column, cell)) return *error;
  }
  return with_plain_text(std::move(entry), column.field, cell);
}

}  // namespace slipfit::reading
