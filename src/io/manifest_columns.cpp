#include "io/manifest_fields.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "core/word_list.hpp"
#include "io/cells.hpp"
#include "io/message.hpp"

namespace slipfit::reading {

namespace {

/// "mm_per_s" is "mm/s".
std::string spelled_out(std::string_view unit) {
  std::string text(unit);
  for (auto at = text.find("_per_"); at != std::string::npos; at = text.find("_per_")) text.replace(at, 5, "/");
  return text;
}

/// The unit after the base of a column name: none, "[mm/s]", "(mm/s)" or "_mm_per_s".
struct UnitText {
  std::string unit;
  bool in_brackets = false;
};

std::optional<UnitText> unit_behind(std::string_view name, std::string_view base) {
  const auto same = [](char a, char b) { return a == std::tolower(static_cast<unsigned char>(b)); };
  if (name.size() < base.size() || !std::equal(base.begin(), base.end(), name.begin(), same)) return std::nullopt;
  const std::string_view rest = trim(name.substr(base.size()));
  if (rest.empty()) return UnitText{};
  if (rest.size() > 2 && ((rest.front() == '[' && rest.back() == ']') || (rest.front() == '(' && rest.back() == ')'))) {
    return UnitText{std::string(trim(rest.substr(1, rest.size() - 2))), true};
  }
  return rest.front() == '_' ? std::optional(UnitText{spelled_out(rest.substr(1)), false}) : std::nullopt;
}

/// Nothing where the name is unknown. Error: unknown_unit, in brackets only ("speed_old" is some other column).
Result<std::optional<ManifestColumn>> recognise(const std::string& name, std::size_t index, const std::string& place) {
  for (const ManifestField& field : manifest_fields()) {
    const auto text = unit_behind(name, field.said.column);
    if (!text) continue;
    if (text->unit.empty()) return std::optional(ManifestColumn{&field, index, printable(name), std::nullopt, {}});
    if (!field.dimension) continue;
    const Result<UnitScale> unit = parse_unit(text->unit, *field.dimension);
    if (unit) {
      const bool is_si = unit.value().scale == 1.0;
      return std::optional(ManifestColumn{&field, index, printable(name), unit.value().scale,
                                          is_si ? std::string() : printable(text->unit)});
    }
    if (!text->in_brackets) continue;
    if (*field.dimension == Dimension::Speed && parse_unit(text->unit, Dimension::AngularSpeed)) {
      return Error{
          "unknown_unit",
          fmt::format("{}: column '{}': '{}' is a rotation, expected the speed at the contact (rotation in rad/s "
                      "times the radius), such as speed [mm/s]",
                      place, printable(name), printable(text->unit))};
    }
    return Error{"unknown_unit",
                 fmt::format("{}: column '{}': {}", place, printable(name), printable(unit.error().message))};
  }
  return std::optional<ManifestColumn>();
}

const ManifestColumn* find_read(const ManifestColumns& columns, const ManifestField* field) {
  const auto found =
      std::ranges::find_if(columns.read, [field](const ManifestColumn& column) { return column.field == field; });
  return found == columns.read.end() ? nullptr : &*found;
}

/// The quantity to which a standard error belongs, which is read first, and the way it is stated; empty if the column
/// is not a standard error.
struct Measured {
  double value = 0.0;  ///< 0: not stated
  const char* absent = nullptr;
  const char* expected = nullptr;
};
std::optional<Measured> measured_by(std::string_view column, const ManifestEntry& entry) {
  if (column == "speed_se") {
    return Measured{entry.conditions.speed_m_per_s, "no_speed",
                    "a speed as well (--speed), of which it is a percentage"};
  }
  if (column == "mass_se") {
    return Measured{entry.conditions.mass_kg.value_or(0.0), "no_mass",
                    "a mass as well (--mass), of which it is a percentage"};
  }
  return std::nullopt;
}

/// A speed as it is, or a rotation times the radius, which is read before it.
Result<double> speed_in(const std::string& text, const ManifestEntry& entry) {
  const auto rotation = parse_quantity(text, Dimension::AngularSpeed);
  Result<double> speed = parse_quantity(text, Dimension::Speed);
  if (speed || !rotation) return speed;
  if (entry.options.radius_m) return rotation.value() * *entry.options.radius_m;
  return Error{"out_of_range",
               fmt::format("'{}' is a rotation: add --radius, the distance of the contact from the axis", text)};
}

/// In SI: plain where the name has a unit, else a number that may bring its own.
Result<double> number_in(const std::string& text, const ManifestEntry& entry, const ManifestColumn& column,
                         bool decimal_comma) {
  const ManifestField& field = *column.field;
  if (!column.scale) {
    const auto share = parse_quantity(text, Dimension::Dimensionless);
    const std::optional<Measured> measured = measured_by(field.said.column, entry);
    if (measured && text.ends_with('%') && share) {
      if (measured->value > 0.0) return share.value() * measured->value;
      return *refusal(measured->absent, text, measured->expected);
    }
    Result<double> value =
        field.dimension == Dimension::Speed ? speed_in(text, entry) : parse_quantity(text, *field.dimension);
    return value ? value : Result<double>(Error{value.error().code, printable(value.error().message)});
  }
  const Cell number = read_cell(text, decimal_comma && text.find(',') != std::string::npos);
  if (number.kind == CellKind::Number && number.tag.empty()) return number.value * *column.scale;
  return *refusal("bad_number", text, "a plain number in the unit of the column's name");
}

std::optional<Error> set_number(ManifestEntry& entry, const ManifestColumn& column, const std::string& cell,
                                bool decimal_comma) {
  const Result<double> number = number_in(cell, entry, column, decimal_comma);
  if (!number) return number.error();
  using Bound = ManifestField::Bound;
  const Bound bound = column.field->bound;
  const bool is_too_low = bound == Bound::AboveZero && !(number.value() > 0.0);
  if (is_too_low || (bound == Bound::NotNegative && number.value() < 0.0)) {
    return Error{"out_of_range", fmt::format("'{}' is {} zero", printable(cell), is_too_low ? "not above" : "below")};
  }
  if (!std::isfinite(number.value())) return refusal("bad_number", cell, "a finite number");
  column.field->set_number(entry, number.value());
  if (column.field->said.column == "speed") {
    entry.conditions.speed_unit = column.scale ? column.unit : unit_in(cell);
  }
  return std::nullopt;
}

std::optional<Error> set_window(ManifestEntry& entry, const ManifestColumn& column, const std::string& cell,
                                bool decimal_comma) {
  auto wrong = refusal("bad_window", cell, "T0:T1 with T0 < T1, on the recording's own clock");
  const std::size_t colon = cell.find(':');
  if (colon == std::string::npos) return wrong;
  const Result<double> begin_s = number_in(cell.substr(0, colon), entry, column, decimal_comma);
  if (!begin_s) return begin_s.error();
  const Result<double> end_s = number_in(cell.substr(colon + 1), entry, column, decimal_comma);
  if (!end_s) return end_s.error();
  if (!(begin_s.value() < end_s.value())) return wrong;
  entry.options.window = TimeWindow{begin_s.value(), end_s.value()};
  return std::nullopt;
}

/// The order in which cells are read: a rotation needs the radius, a relative standard error what it is of.
int turn_of(std::string_view column) {
  if (column == "speed_se" || column == "mass_se") return 2;
  return column == "speed" ? 1 : 0;
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
    if (const ManifestColumn* const other = find_read(columns, column.value()->field)) {
      return Error{"duplicate_column",
                   fmt::format("{}: the columns '{}' and '{}' state the same quantity, expected one of them", place,
                               other->name, column.value()->name)};
    }
    columns.read.push_back(*column.value());
  }
  for (const ManifestField& field : manifest_fields()) {
    if (field.need == ManifestField::Need::Nothing || find_read(columns, &field) != nullptr) continue;
    const std::string ignored =
        columns.ignored.empty() ? "" : fmt::format(", not understood: {}", fmt::join(columns.ignored, ", "));
    return Error{"missing_column",
                 fmt::format("{}: there is no column '{}'{}; expected a header line such as id,file,speed_m_per_s",
                             place, field.full_name(), ignored)};
  }
  std::ranges::stable_sort(columns.read, [](const ManifestColumn& a, const ManifestColumn& b) {
    return turn_of(a.field->said.column) < turn_of(b.field->said.column);
  });
  return columns;
}

Result<ManifestEntry> with_cell(ManifestEntry entry, const ManifestColumn& column, const std::string& cell,
                                bool decimal_comma) {
  const ManifestField& field = *column.field;
  if (cell.empty() && field.need != ManifestField::Need::Value) return entry;
  const auto error = cell.empty()                  ? Error{"missing_value", "the field is empty, expected a value"}
                     : field.set_text != nullptr   ? field.set_text(entry, cell)
                     : field.set_number != nullptr ? set_number(entry, column, cell, decimal_comma)
                                                   : set_window(entry, column, cell, decimal_comma);
  if (error) return *error;
  return entry;
}

}  // namespace slipfit::reading

namespace slipfit {

using namespace reading;

Result<ManifestEntry> entry_from_cells(std::vector<NamedCell> cells) {
  std::ranges::stable_sort(
      cells, [](const NamedCell& a, const NamedCell& b) { return turn_of(a.column) < turn_of(b.column); });
  ManifestEntry entry;
  for (const NamedCell& cell : cells) {
    const auto column = recognise(cell.column, 0, cell.column);
    if (!column || !column.value()) {
      return Error{"unknown_option", fmt::format("there is no option '{}'", printable(cell.column))};
    }
    auto with = with_cell(std::move(entry), *column.value(), cell.text, false);
    if (!with) {
      const std::string place = cell.place.empty() ? fmt::format("column '{}'", cell.column) : cell.place;
      return Error{with.error().code, fmt::format("{}: {}", place, with.error().message)};
    }
    entry = std::move(with).value();
  }
  return entry;
}

}  // namespace slipfit
