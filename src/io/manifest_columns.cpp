#include "io/manifest_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>

#include "io/cells.hpp"
#include "io/manifest_setters.hpp"
#include "io/message.hpp"
#include "slipfit/core/units.hpp"

namespace slipfit::reading {

struct ManifestField {
  enum class Bound { AboveZero, NotNegative, None };
  std::string_view base;
  std::string_view suffix{};             ///< behind the base: the SI unit of the full name
  std::optional<Dimension> dimension{};  ///< empty: text
  Bound bound = Bound::None;
  void (*set_number)(ManifestEntry&, double) = nullptr;  ///< nothing and `dimension`: a window
  std::optional<Error> (*set_text)(ManifestEntry&, const std::string&) = nullptr;
  std::string_view option{};  ///< of the command line, that says the same
  bool is_needed = false;
  bool may_be_empty = false;  ///< although the column is needed

  [[nodiscard]] std::string full_name() const { return std::string(base) + std::string(suffix); }
};

namespace {

using Bound = ManifestField::Bound;

// A name that begins like another one stands before it.
constexpr std::array kFields = std::to_array<ManifestField>({
    {.base = "id", .set_text = set_id, .is_needed = true},
    {.base = "file", .set_text = set_path<&ManifestEntry::file>, .is_needed = true},
    {"speed_se", "_m_per_s", Dimension::Speed, Bound::NotNegative,
     set_condition<&Conditions::speed_standard_error_m_per_s>},
    {"speed", "_m_per_s", Dimension::Speed, Bound::AboveZero, set_condition<&Conditions::speed_m_per_s>, nullptr,
     "--speed", true, true},
    {"normal_force", "_N", Dimension::Force, Bound::AboveZero, set_condition<&Conditions::normal_force_N>},
    {"zero_force", "_N", Dimension::Force, Bound::None, set_condition<&Conditions::zero_force_N>},
    {.base = "force_view", .set_text = set_force_view},
    {.base = "group", .set_text = set_label<&Labels::group>},
    {.base = "sample", .set_text = set_label<&Labels::sample>},
    {.base = "material", .set_text = set_label<&Labels::material>},
    {.base = "operator", .set_text = set_label<&Labels::operator_name>},
    {.base = "time_column", .set_text = set_option<&ReadOptions::time_column>, .option = "--time-column"},
    {.base = "force_column", .set_text = set_option<&ReadOptions::force_column>, .option = "--force-column"},
    {.base = "normal_force_column",
     .set_text = set_option<&ReadOptions::normal_force_column>,
     .option = "--normal-force-column"},
    {.base = "speed_column", .set_text = set_option<&ReadOptions::speed_column>, .option = "--speed-column"},
    {.base = "surface", .set_text = set_path<&ManifestEntry::surface>, .option = "--surface"},
    {.base = "sheet", .set_text = set_option<&ReadOptions::sheet>, .option = "--sheet"},
    {.base = "variable", .set_text = set_option<&ReadOptions::variable>, .option = "--variable"},
    {.base = "step", .set_text = set_step, .option = "--step"},
    {.base = "rows", .set_text = set_rows, .option = "--rows"},
    {.base = "where", .set_text = set_where, .option = "--where"},
    {.base = "strokes", .set_text = set_strokes, .option = "--strokes"},
    {.base = "segments", .set_text = set_segments, .option = "--segments"},
    {.base = "force_scale", .set_text = set_force_scale, .option = "--force-scale"},
    {.base = "time_unit", .set_text = set_unit<Dimension::Time, &ReadOptions::time_unit>, .option = "--time-unit"},
    {.base = "force_unit", .set_text = set_unit<Dimension::Force, &ReadOptions::force_unit>, .option = "--force-unit"},
    {"sample_rate", "_Hz", Dimension::Frequency, Bound::AboveZero,
     [](ManifestEntry& entry, double number) { entry.options.sample_rate_Hz = number; }, nullptr, "--sample-rate"},
    {.base = "window", .suffix = "_s", .dimension = Dimension::Time, .option = "--window"},
    {"mass", "_kg", Dimension::Mass, Bound::AboveZero, set_condition<&Conditions::mass_kg>},
    {"radius", "_m", Dimension::Length, Bound::AboveZero,
     [](ManifestEntry& entry, double number) { entry.options.radius_m = number; }},
    {"sensor_bandwidth", "_Hz", Dimension::Frequency, Bound::AboveZero,
     set_condition<&Conditions::sensor_bandwidth_Hz>},
    {"sensor_resonance", "_Hz", Dimension::Frequency, Bound::AboveZero,
     set_condition<&Conditions::sensor_resonance_Hz>},
    {"drive_period", "_s", Dimension::Time, Bound::AboveZero, set_condition<&Conditions::drive_period_s>},
    {"sensor_average", "_s", Dimension::Time, Bound::NotNegative, set_condition<&Conditions::sensor_average_s>},
    {"measured_spacing_se", "_m", Dimension::Length, Bound::NotNegative,
     set_condition<&Conditions::measured_spacing_se_m>},
    {"measured_spacing", "_m", Dimension::Length, Bound::AboveZero, set_condition<&Conditions::measured_spacing_m>},
});

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
  for (const ManifestField& field : kFields) {
    const auto text = unit_behind(name, field.base);
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
  const auto found = std::find_if(columns.read.begin(), columns.read.end(),
                                  [field](const ManifestColumn& column) { return column.field == field; });
  return found == columns.read.end() ? nullptr : &*found;
}

/// In SI: plain where the name has a unit, else a number that may bring its own.
Result<double> number_in(const std::string& text, const ManifestColumn& column, const std::string& cell,
                         bool decimal_comma) {
  if (!column.scale) {
    Result<double> value = parse_quantity(text, *column.field->dimension);
    return value ? value : Result<double>(Error{value.error().code, printable(value.error().message)});
  }
  const Cell number = read_cell(text, decimal_comma && text.find(',') != std::string::npos);
  if (number.kind == CellKind::Number && number.tag.empty()) return number.value * *column.scale;
  return *refusal("bad_number", cell, "a plain number, in the unit that the column's name gives");
}

std::optional<Error> set_number(ManifestEntry& entry, const ManifestColumn& column, const std::string& cell,
                                bool decimal_comma) {
  const Result<double> number = number_in(cell, column, cell, decimal_comma);
  if (!number) return number.error();
  const Bound bound = column.field->bound;
  const bool is_too_low = bound == Bound::AboveZero && !(number.value() > 0.0);
  if (is_too_low) return refusal("out_of_range", cell, "a number above zero");
  if (bound == Bound::NotNegative && number.value() < 0.0) return refusal("out_of_range", cell, "zero or more");
  column.field->set_number(entry, number.value());
  if (column.field->base == "speed") entry.conditions.speed_unit = column.scale ? column.unit : unit_in(cell);
  return std::nullopt;
}

std::optional<Error> set_window(ManifestEntry& entry, const ManifestColumn& column, const std::string& cell,
                                bool decimal_comma) {
  auto wrong = refusal("bad_window", cell, "T0:T1 with T0 < T1, on the recording's own clock");
  const std::size_t colon = cell.find(':');
  if (colon == std::string::npos) return wrong;
  const Result<double> begin_s = number_in(cell.substr(0, colon), column, cell, decimal_comma);
  if (!begin_s) return begin_s.error();
  const Result<double> end_s = number_in(cell.substr(colon + 1), column, cell, decimal_comma);
  if (!end_s) return end_s.error();
  if (!(begin_s.value() < end_s.value())) return wrong;
  entry.options.window = TimeWindow{begin_s.value(), end_s.value()};
  return std::nullopt;
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
      return Error{"duplicate_column", fmt::format("{}: the columns '{}' and '{}' say the same, expected one of them",
                                                   place, other->name, column.value()->name)};
    }
    columns.read.push_back(*column.value());
  }
  for (const ManifestField& field : kFields) {
    if (!field.is_needed || find_read(columns, &field) != nullptr) continue;
    const std::string ignored =
        columns.ignored.empty() ? "" : fmt::format(", not understood: {}", fmt::join(columns.ignored, ", "));
    return Error{"missing_column", fmt::format("{}: there is no column '{}'{}; expected a line of names such as "
                                               "id,file,speed_m_per_s",
                                               place, field.full_name(), ignored)};
  }
  return columns;
}

std::optional<ManifestColumn> column_called(const std::string& name) {
  const auto column = recognise(name, 0, name);
  return column ? column.value() : std::nullopt;
}

Result<ManifestEntry> with_cell(ManifestEntry entry, const ManifestColumn& column, const std::string& cell,
                                bool decimal_comma) {
  const ManifestField& field = *column.field;
  if (cell.empty() && (!field.is_needed || field.may_be_empty)) return entry;
  const auto error = cell.empty()                  ? Error{"missing_value", "the field is empty, expected a value"}
                     : field.set_text != nullptr   ? field.set_text(entry, cell)
                     : field.set_number != nullptr ? set_number(entry, column, cell, decimal_comma)
                                                   : set_window(entry, column, cell, decimal_comma);
  if (error) return Error{error->code, fmt::format("column '{}': {}", column.name, error->message)};
  return entry;
}

std::string with_columns_for_options(std::string text) {
  for (const ManifestField& field : kFields) {
    if (field.option.empty()) continue;
    const std::string words = "the manifest's " + field.full_name();
    for (std::size_t at = 0; (at = text.find(field.option, at)) != std::string::npos;) {
      const std::size_t end = at + field.option.size();
      const bool is_longer = end < text.size() && text[end] == '-';  // "--speed" of "--speed-column"
      if (!is_longer) text.replace(at, field.option.size(), words);
      at += is_longer ? field.option.size() : words.size();
    }
  }
  return text;
}

}  // namespace slipfit::reading
