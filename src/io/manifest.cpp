#include "slipfit/io/manifest.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <exception>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/counted.hpp"
#include "core/thrown_error.hpp"
#include "core/word_list.hpp"
#include "io/cells.hpp"
#include "io/message.hpp"
#include "io/read_options.hpp"
#include "io/text_lines.hpp"
#include "io/text_source.hpp"
#include "slipfit/core/units.hpp"
#include "slipfit/io/manifest_entry.hpp"

namespace slipfit::reading {

/// A property of a recording that can be stated: one table for manifests, the command line and programs that state it
/// as text.
struct ManifestField {
  enum class Bound { AboveZero, NotNegative, None };
  enum class Need { Nothing, Column, Value };  ///< of a manifest
  using SetNumber = void(ManifestEntry&, double);
  using SetText = void(ManifestEntry&, const std::string&);
  using CellOf = std::optional<std::string>(const ReadOptions&);

  RecordingOption said;
  std::string_view suffix{};             ///< after the column's name: its SI unit
  std::optional<Dimension> dimension{};  ///< empty: text
  Bound bound = Bound::None;
  SetNumber* set_number = nullptr;  ///< nothing and `dimension`: a window
  SetText* set_text = nullptr;
  Need need = Need::Nothing;
  CellOf* cell_of = nullptr;  ///< the cell of an option of reading, in SI; empty if it is not stated

  [[nodiscard]] std::string full_name() const { return std::string(said.column) + std::string(suffix); }
};

/// A column that is read: its position, its name, and its conversion to SI.
struct ManifestColumn {
  const ManifestField* field = nullptr;
  std::size_t index = 0;
  std::string name;             ///< as in the file
  std::optional<double> scale;  ///< empty: no unit in the name, then a number is in SI or brings its unit
  std::string unit;             ///< in the name, other than SI
};

struct ManifestColumns {
  std::vector<ManifestColumn> read;
  std::vector<std::string> ignored;
  std::size_t count = 0;  ///< of all columns
};

}  // namespace slipfit::reading

namespace slipfit {
namespace {

using namespace reading;

/// Returns the error of a cell: "bad value 'x', expected a number".
ThrownError refusal(const char* code, const std::string& cell, const char* expected) {
  return ThrownError({code, fmt::format("bad value '{}', expected {}", printable_utf8(cell), expected)});
}

// Setters for cells of text. They throw if a cell is not valid.

ManifestEntry& owner_of(auto ManifestEntry::* /*member*/, ManifestEntry& entry) {
  return entry;
}
Conditions& owner_of(auto Conditions::* /*member*/, ManifestEntry& entry) {
  return entry.conditions;
}
ReadOptions& owner_of(auto ReadOptions::* /*member*/, ManifestEntry& entry) {
  return entry.options;
}

template <auto member>
void set_number_of(ManifestEntry& entry, double number) {
  owner_of(member, entry).*member = number;
}

/// The speed is read before. An error of half of it or more is a mistaken unit.
void set_speed_error(ManifestEntry& entry, double error_m_per_s) {
  const double speed_m_per_s = entry.conditions.speed_m_per_s;
  if (speed_m_per_s > 0.0 && error_m_per_s > 0.5 * speed_m_per_s) {
    throw ThrownError({"out_of_range", fmt::format("{:.4g} m/s is more than half of the speed, {:.4g} m/s",
                                                   error_m_per_s, speed_m_per_s)});
  }
  entry.conditions.speed_standard_error_m_per_s = error_m_per_s;
}

template <auto member>
void set_text_of(ManifestEntry& entry, const std::string& cell) {
  owner_of(member, entry).*member = cell;
}

void set_id(ManifestEntry& entry, const std::string& cell) {
  const bool has_slash = cell.find_first_of("/\\") != std::string::npos;
  const bool has_control =
      std::ranges::any_of(cell, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; });
  if (has_slash || has_control || cell.starts_with("group:")) {
    throw refusal("bad_id", cell, "a name without slash or control character that does not start with 'group:'");
  }
  entry.id = to_utf8(cell);
}

template <auto Labels::*target>
void set_label(ManifestEntry& entry, const std::string& cell) {
  entry.conditions.labels.*target = to_utf8(cell);
}

void set_force_view(ManifestEntry& entry, const std::string& cell) {
  constexpr auto kViews = std::to_array<std::pair<std::string_view, ForceView>>(
      {{"spring", ForceView::Spring}, {"transmitted", ForceView::Transmitted}, {"contact", ForceView::Contact}});
  const auto* const view = std::ranges::find_if(kViews, [&](const auto& v) { return v.first == cell; });
  if (view == kViews.end()) throw refusal("unknown_force_view", cell, "spring, transmitted or contact");
  entry.conditions.force_view = view->second;
}

void set_drift(ManifestEntry& entry, const std::string& cell) {
  constexpr auto kReadings = std::to_array<std::pair<std::string_view, LevelReading>>(
      {{"sensor", LevelReading::Sensor}, {"friction", LevelReading::Friction}, {"none", LevelReading::None}});
  const auto* const reading =
      std::find_if(kReadings.begin(), kReadings.end(), [&](const auto& r) { return r.first == cell; });
  if (reading == kReadings.end()) throw refusal("unknown_drift", cell, "sensor, friction or none");
  entry.conditions.drift = reading->second;
}

/// "4, 200 Hz": order and corner of a Butterworth response.
void set_sensor_filter(ManifestEntry& entry, const std::string& cell) {
  const std::size_t comma = cell.find_first_of(",;");
  const double order = plain_number(std::string_view(cell).substr(0, comma), false);
  const bool is_order = order >= 1.0 && order <= static_cast<double>(kHighestFilterOrder) && order == std::floor(order);
  const Result<double> corner_Hz = comma == std::string::npos
                                       ? Result<double>(Error{"bad_sensor_filter", ""})
                                       : parse_quantity(std::string_view(cell).substr(comma + 1), Dimension::Frequency);
  if (!is_order || !corner_Hz || !(corner_Hz.value() > 0.0)) {
    throw refusal("bad_sensor_filter", cell, "an order from 1 to 8 and a corner frequency, such as '4, 200 Hz'");
  }
  if (entry.conditions.sensor_bandwidth_Hz) {
    throw refusal("conflicting_sensor", cell, "either a bandwidth (first order) or a filter");
  }
  entry.conditions.sensor_bandwidth_Hz = corner_Hz.value();
  entry.conditions.sensor_filter_order = static_cast<std::size_t>(order);
}

template <Dimension dimension, std::optional<std::string> ReadOptions::*target>
void set_unit(ManifestEntry& entry, const std::string& cell) {
  const Result<double> unit = parse_unit(cell, dimension);
  const bool is_other = dimension == Dimension::Force &&
                        (parse_unit(cell, Dimension::Dimensionless) || parse_unit(cell, Dimension::Torque));
  if (!unit && !is_other) throw ThrownError({"unknown_unit", printable_utf8(unit.error().message)});
  entry.options.*target = cell;
}

void set_step(ManifestEntry& entry, const std::string& cell) {
  const double step = plain_number(cell, false);
  if (!(step >= 0.0 && step < 1e9 && step == std::floor(step)))
    throw refusal("bad_step", cell, "the number of a step as listed by slipfit info");
  entry.options.step = static_cast<std::size_t>(step);
}

/// Parses "A:B" with 1 <= A < B.
std::optional<RowRange> parse_row_range(std::string_view text) {
  RowRange rows;
  const char* const end = text.data() + text.size();
  const auto [colon, first_error] = std::from_chars(text.data(), end, rows.first);
  if (first_error != std::errc() || colon == end || *colon != ':') return std::nullopt;
  const auto [stop, last_error] = std::from_chars(colon + 1, end, rows.last);
  const bool is_range = last_error == std::errc() && stop == end && rows.first >= 1 && rows.first < rows.last;
  return is_range ? std::optional(rows) : std::nullopt;
}

void set_rows(ManifestEntry& entry, const std::string& cell) {
  entry.options.rows = parse_row_range(cell);
  if (!entry.options.rows) throw refusal("bad_rows", cell, "A:B with 1 <= A < B, rows counted from 1");
}

/// Parses "COLUMN=VALUE"; the name of a column may contain an equals sign, the value may not.
std::optional<ColumnValue> parse_column_value(std::string_view text) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string_view::npos) return std::nullopt;
  const std::string_view column = trim(text.substr(0, equals));
  const std::string_view value = trim(text.substr(equals + 1));
  if (column.empty() || value.empty()) return std::nullopt;
  return ColumnValue{std::string(column), std::string(value)};
}

void set_where(ManifestEntry& entry, const std::string& cell) {
  entry.options.where = parse_column_value(cell);
  if (!entry.options.where) throw refusal("bad_where", cell, "COLUMN=VALUE");
}

/// Strokes or segments.
void set_pieces(ManifestEntry& entry, const std::string& cell, Pieces pieces) {
  if (entry.options.pieces != Pieces::One) throw refusal("conflicting_pieces", cell, "either strokes or segments");
  entry.options.pieces = pieces;
}

/// Parses "both" or an empty text, "positive", "negative".
std::optional<Pieces> parse_strokes(std::string_view text) {
  if (text.empty() || text == "both") return Pieces::Strokes;
  if (text == "positive") return Pieces::PositiveStrokes;
  return text == "negative" ? std::optional(Pieces::NegativeStrokes) : std::nullopt;
}

void set_strokes(ManifestEntry& entry, const std::string& cell) {
  const auto strokes = parse_strokes(cell);
  if (!strokes) throw refusal("bad_strokes", cell, "both, positive or negative");
  set_pieces(entry, cell, *strokes);
}

void set_segments(ManifestEntry& entry, const std::string& cell) {
  if (cell == "yes") return set_pieces(entry, cell, Pieces::Segments);
  if (cell != "no") throw refusal("bad_segments", cell, "yes or no");
}

void set_force_scale(ManifestEntry& entry, const std::string& cell) {
  if (!parse_force_scale(cell)) throw refusal("unknown_unit", cell, "newtons per unit, such as 5 N/V");
  entry.options.force_scale = cell;
}

using Bound = ManifestField::Bound;
using Need = ManifestField::Need;
using Of = RecordingOption::Of;

// Cells that state options of reading.

std::string text_of(const RowRange& rows) {
  return fmt::format("{}:{}", rows.first, rows.last);
}
std::string text_of(const ColumnValue& where) {
  return where.column + "=" + where.value;
}
std::string text_of(const TimeWindow& window) {
  return fmt::format("{}:{}", window.begin_s, window.end_s);
}
template <class Value>
std::string text_of(const Value& value) {
  return fmt::format("{}", value);
}

template <auto member>
std::optional<std::string> cell_of(const ReadOptions& options) {
  const auto& stated = options.*member;
  return stated ? std::optional(text_of(*stated)) : std::nullopt;
}

std::optional<std::string> strokes_cell(const ReadOptions& options) {
  for (const char* const strokes : {"both", "positive", "negative"}) {
    if (parse_strokes(strokes) == options.pieces) return strokes;
  }
  return std::nullopt;
}

std::optional<std::string> segments_cell(const ReadOptions& options) {
  return options.pieces == Pieces::Segments ? std::optional<std::string>("yes") : std::nullopt;
}

constexpr std::string_view kColumnHelp = "Name or 1-based number";

constexpr ManifestField text_field(RecordingOption said, ManifestField::SetText* set_text, Need need = Need::Nothing) {
  return {.said = said, .set_text = set_text, .need = need};
}
constexpr ManifestField text_field(RecordingOption said, ManifestField::SetText* set_text,
                                   ManifestField::CellOf* cell) {
  return {.said = said, .set_text = set_text, .cell_of = cell};
}

constexpr ManifestField number_field(RecordingOption said, std::string_view suffix, Dimension dimension, Bound bound,
                                     ManifestField::SetNumber* set_number, Need need = Need::Nothing,
                                     ManifestField::CellOf* cell = nullptr) {
  return {said, suffix, dimension, bound, set_number, nullptr, need, cell};
}

// In the order of the help.
constexpr std::array kFields = std::to_array<ManifestField>({
    text_field({"id"}, set_id, Need::Value),
    text_field({"file"}, set_text_of<&ManifestEntry::file>, Need::Value),
    number_field(
        {"speed", "--speed",
         "Driving speed: 0.01 (m/s), 10mm/s, '600 mm/min'; 10mm/s,20mm/s of two recordings; 60rpm with --radius"},
        "_m_per_s", Dimension::Speed, Bound::AboveZero, set_number_of<&Conditions::speed_m_per_s>, Need::Column),
    number_field({"speed_se", "--speed-uncertainty", "Standard error of the speed: 0.1mm/s, or a percentage: 1%"},
                 "_m_per_s", Dimension::Speed, Bound::NotNegative, set_speed_error),
    number_field({"normal_force", "--normal-force", "Normal force: 5 (N), '41 gf'"}, "_N", Dimension::Force,
                 Bound::AboveZero, set_number_of<&Conditions::normal_force_N>),
    number_field({"zero_force", "--zero", "Sensor reading at no force (N); absolute forces need it"}, "_N",
                 Dimension::Force, Bound::None, set_number_of<&Conditions::zero_force_N>),
    number_field({"mass", "--mass",
                  "Moving mass: 0.0307 (kg), '30.7 g'; used for w_n if averaging by the sensor conceals it, otherwise "
                  "compared with k/w_n^2"},
                 "_kg", Dimension::Mass, Bound::AboveZero, set_number_of<&Conditions::mass_kg>),
    number_field({"mass_se", "--mass-uncertainty", "Standard error of the mass: 5g, or a percentage: 1% (default: 2%)"},
                 "_kg", Dimension::Mass, Bound::NotNegative, set_number_of<&Conditions::mass_standard_error_kg>),
    number_field({"sensor_bandwidth", "--sensor-bandwidth",
                  "Bandwidth (-3 dB) of the sensor, first order: 500 (Hz), 2kHz; the model includes the lag"},
                 "_Hz", Dimension::Frequency, Bound::AboveZero, set_number_of<&Conditions::sensor_bandwidth_Hz>),
    text_field(
        {"sensor_filter", "--sensor-filter",
         "Low-pass filter of the instrument (Butterworth): order and corner, '4, 200 Hz'; the model includes it"},
        set_sensor_filter),
    number_field(
        {"sensor_average", "--sensor-average,--averaging",
         "Time over which each sample is averaged: 0.002 (s), 2ms, 0 for none; the model includes the averaging"},
        "_s", Dimension::Time, Bound::NotNegative, set_number_of<&Conditions::sensor_average_s>),
    number_field({"sensor_resonance", "--sensor-resonance", "Natural frequency of the load cell: 800 (Hz), 2kHz"},
                 "_Hz", Dimension::Frequency, Bound::AboveZero, set_number_of<&Conditions::sensor_resonance_Hz>),
    number_field(
        {"drive_period", "--drive-period", "Period of a possible excitation, such as the steps of a motor: 20ms"}, "_s",
        Dimension::Time, Bound::AboveZero, set_number_of<&Conditions::drive_period_s>),
    number_field({"drive_path", "--drive-path",
                  "Displacement after which the force of the drive repeats, such as a tooth or a turn: 2mm"},
                 "_m", Dimension::Length, Bound::AboveZero, set_number_of<&Conditions::drive_path_m>),
    text_field(
        {"force_view", "--force-view", "spring|transmitted|contact: force that the sensor measures (default: spring)"},
        set_force_view),
    text_field(
        {"drift", "--drift",
         "sensor|friction|none: cause of a trend of the force level (drift, change, no trend); default: intervals "
         "include sensor and friction unless the data decide"},
        set_drift),
    text_field({"group"}, set_label<&Labels::group>),
    text_field({"sample"}, set_label<&Labels::sample>),
    text_field({"material"}, set_label<&Labels::material>),
    text_field({"operator"}, set_label<&Labels::operator_name>),
    text_field({"surface", "--surface"}, set_text_of<&ManifestEntry::surface>),
    number_field({"measured_spacing_se"}, "_m", Dimension::Length, Bound::NotNegative,
                 set_number_of<&Conditions::measured_spacing_se_m>),
    number_field({"measured_spacing"}, "_m", Dimension::Length, Bound::AboveZero,
                 set_number_of<&Conditions::measured_spacing_m>),
    text_field({"time_column", "--time-column", kColumnHelp, Of::Reading}, set_text_of<&ReadOptions::time_column>,
               cell_of<&ReadOptions::time_column>),
    text_field({"force_column", "--force-column", kColumnHelp, Of::Reading}, set_text_of<&ReadOptions::force_column>,
               cell_of<&ReadOptions::force_column>),
    text_field({"normal_force_column", "--normal-force-column", kColumnHelp, Of::Reading},
               set_text_of<&ReadOptions::normal_force_column>, cell_of<&ReadOptions::normal_force_column>),
    text_field(
        {"speed_column", "--speed-column", "Name or 1-based number; a column in rpm needs --radius", Of::Reading},
        set_text_of<&ReadOptions::speed_column>, cell_of<&ReadOptions::speed_column>),
    number_field(
        {"radius", "--radius",
         "Distance of the contact from the axis of rotation: 12mm; for a torque or a rotational speed", Of::Reading},
        "_m", Dimension::Length, Bound::AboveZero, set_number_of<&ReadOptions::radius_m>, Need::Nothing,
        cell_of<&ReadOptions::radius_m>),
    text_field({"time_unit", "--time-unit", "Unit of the time column: ms, min", Of::Reading},
               set_unit<Dimension::Time, &ReadOptions::time_unit>, cell_of<&ReadOptions::time_unit>),
    text_field({"force_unit", "--force-unit",
                "Unit of the force column: mN, kgf; 1 for a coefficient, 'N m' for a torque", Of::Reading},
               set_unit<Dimension::Force, &ReadOptions::force_unit>, cell_of<&ReadOptions::force_unit>),
    text_field({"force_scale", "--force-scale", "Force per unit of the force column: '5 N/V'", Of::Reading},
               set_force_scale, cell_of<&ReadOptions::force_scale>),
    number_field(
        {"sample_rate", "--sample-rate", "Sampling rate (Hz) of a recording without a time column", Of::Reading}, "_Hz",
        Dimension::Frequency, Bound::AboveZero, set_number_of<&ReadOptions::sample_rate_Hz>, Need::Nothing,
        cell_of<&ReadOptions::sample_rate_Hz>),
    text_field(
        {"sheet", "--sheet", "Sheet of a workbook or file in a zip archive: name or 1-based number", Of::Reading},
        set_text_of<&ReadOptions::sheet>, cell_of<&ReadOptions::sheet>),
    text_field({"variable", "--variable",
                "Variable of a .mat file, dataset or group of an HDF5 file, group of a TDMS file", Of::Reading},
               set_text_of<&ReadOptions::variable>, cell_of<&ReadOptions::variable>),
    text_field({"step", "--step", "Step of a file with several steps (slipfit info lists them)", Of::Reading}, set_step,
               cell_of<&ReadOptions::step>),
    text_field({"rows", "--rows", "A:B, range of rows of numbers, counted from 1", Of::Reading}, set_rows,
               cell_of<&ReadOptions::rows>),
    text_field(
        {"where", "--where", "COLUMN=VALUE: only rows with this value in this column (name or number)", Of::Reading},
        set_where, cell_of<&ReadOptions::where>),
    number_field({"window", "--window", "T0:T1, part of the recording, in seconds of its own clock", Of::Reading}, "_s",
                 Dimension::Time, Bound::None, nullptr, Need::Nothing, cell_of<&ReadOptions::window>),
    text_field(
        {"strokes", "--strokes{both}",
         "Reciprocating test: each stroke becomes a recording; --strokes=positive or =negative selects one direction",
         Of::Pieces},
        set_strokes, strokes_cell),
    text_field({"segments", "--segments{yes}",
                "Each section of constant speed becomes a recording: a sweep in one file", Of::Pieces},
               set_segments, segments_cell),
});

/// Returns an error's text for the user of a manifest: it names columns of the manifest, not options of the command
/// line.
std::string with_columns_for_options(std::string text) {
  for (const ManifestField& field : kFields) {
    const std::string_view option = field.said.name();
    if (option.empty()) continue;
    const std::string words = "the manifest's " + field.full_name();
    for (std::size_t at = 0; (at = text.find(option, at)) != std::string::npos;) {
      const std::size_t end = at + option.size();
      const bool is_longer = end < text.size() && text[end] == '-';  // "--speed" of "--speed-column"
      if (!is_longer) text.replace(at, option.size(), words);
      at += is_longer ? option.size() : words.size();
    }
  }
  return text;
}

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

std::optional<UnitText> unit_after(std::string_view name, std::string_view base) {
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
std::optional<ManifestColumn> recognise(const std::string& name, std::size_t index, const std::string& place) {
  for (const ManifestField& field : kFields) {
    const auto text = unit_after(name, field.said.column);
    if (!text) continue;
    if (text->unit.empty()) return ManifestColumn{&field, index, printable_utf8(name), std::nullopt, {}};
    if (!field.dimension) continue;
    const std::string shown = printable_utf8(text->unit);
    const Result<double> unit = parse_unit(text->unit, *field.dimension);
    if (unit.ok()) {
      const bool is_si = unit.value() == 1.0;
      return ManifestColumn{&field, index, printable_utf8(name), unit.value(), is_si ? std::string() : shown};
    }
    if (text->in_brackets) {
      const bool is_rotation =
          *field.dimension == Dimension::Speed && parse_unit(text->unit, Dimension::AngularSpeed).ok();
      const std::string cause =
          is_rotation ? fmt::format(
                            "'{}' is a rotation, expected the speed at the contact (rotation in rad/s times the "
                            "radius), such as speed [mm/s]",
                            shown)
                      : printable_utf8(unit.error().message);
      throw ThrownError({"unknown_unit", fmt::format("{}: column '{}': {}", place, printable_utf8(name), cause)});
    }
  }
  return std::nullopt;
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
double number_in(const std::string& text, const ManifestEntry& entry, const ManifestColumn& column,
                 bool decimal_comma) {
  const ManifestField& field = *column.field;
  if (column.scale) {
    const Cell number = read_cell(text, decimal_comma && text.find(',') != std::string::npos);
    if (number.kind == CellKind::Number && number.tag.empty()) return number.value * *column.scale;
    throw refusal("bad_number", text, "a plain number in the unit of the column's name");
  }
  const auto share = parse_quantity(text, Dimension::Dimensionless);
  const std::optional<Measured> measured = measured_by(field.said.column, entry);
  if (measured && text.ends_with('%') && share) {
    if (measured->value > 0.0) return share.value() * measured->value;
    throw refusal(measured->absent, text, measured->expected);
  }
  const Result<double> value =
      field.dimension == Dimension::Speed ? speed_in(text, entry) : parse_quantity(text, *field.dimension);
  if (value) return value.value();
  throw ThrownError({value.error().code, printable_utf8(value.error().message)});
}

void set_number(ManifestEntry& entry, const ManifestColumn& column, const std::string& cell, bool decimal_comma) {
  const double number = number_in(cell, entry, column, decimal_comma);
  const bool is_too_low = column.field->bound == Bound::AboveZero && !(number > 0.0);
  if (is_too_low || (column.field->bound == Bound::NotNegative && number < 0.0)) {
    throw ThrownError(
        {"out_of_range", fmt::format("'{}' is {} zero", printable_utf8(cell), is_too_low ? "not above" : "below")});
  }
  if (!std::isfinite(number)) throw refusal("bad_number", cell, "a finite number");
  column.field->set_number(entry, number);
  if (column.field->said.column == "speed") {
    entry.conditions.speed_unit = column.scale ? column.unit : unit_in(cell);
  }
}

void set_window(ManifestEntry& entry, const ManifestColumn& column, const std::string& cell, bool decimal_comma) {
  const char* const expected = "T0:T1 with T0 < T1, on the recording's own clock";
  const std::size_t colon = cell.find(':');
  if (colon == std::string::npos) throw refusal("bad_window", cell, expected);
  const double begin_s = number_in(cell.substr(0, colon), entry, column, decimal_comma);
  const double end_s = number_in(cell.substr(colon + 1), entry, column, decimal_comma);
  if (!(begin_s < end_s)) throw refusal("bad_window", cell, expected);
  entry.options.window = TimeWindow{begin_s, end_s};
}

/// The order in which cells are read: a rotation needs the radius, a relative standard error what it is of.
int turn_of(std::string_view column) {
  if (column == "speed_se" || column == "mass_se") return 2;
  return column == "speed" ? 1 : 0;
}

/// Finds the columns in the header line, in the order in which their cells have to be read. `place` ("manifest.csv:1")
/// starts each message. Errors: missing_column, duplicate_column, unknown_unit.
ManifestColumns find_manifest_columns(const std::vector<std::string>& names, const std::string& place) {
  ManifestColumns columns;
  columns.count = names.size();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto column = recognise(names[i], i, place);
    if (!column) {
      columns.ignored.push_back(printable_utf8(names[i]));
      continue;
    }
    if (const ManifestColumn* const other = find_read(columns, column->field)) {
      throw ThrownError({"duplicate_column",
                         fmt::format("{}: the columns '{}' and '{}' state the same quantity, expected one of them",
                                     place, other->name, column->name)});
    }
    columns.read.push_back(*column);
  }
  for (const ManifestField& field : kFields) {
    if (field.need == Need::Nothing || find_read(columns, &field) != nullptr) continue;
    const std::string ignored =
        columns.ignored.empty() ? "" : fmt::format(", not understood: {}", fmt::join(columns.ignored, ", "));
    throw ThrownError(
        {"missing_column",
         fmt::format("{}: there is no column '{}'{}; expected a header line such as id,file,speed_m_per_s", place,
                     field.full_name(), ignored)});
  }
  std::ranges::stable_sort(columns.read, [](const ManifestColumn& a, const ManifestColumn& b) {
    return turn_of(a.field->said.column) < turn_of(b.field->said.column);
  });
  return columns;
}

/// Sets what a cell says about the entry. Errors: missing_value, bad_id, bad_number, out_of_range, bad_window,
/// unknown_unit, unknown_force_view, unknown_drift, bad_sensor_filter, conflicting_sensor, no_speed.
void set_cell(ManifestEntry& entry, const ManifestColumn& column, const std::string& cell, bool decimal_comma) {
  const ManifestField& field = *column.field;
  if (cell.empty() && field.need != Need::Value) return;
  if (cell.empty()) throw ThrownError({"missing_value", "the field is empty, expected a value"});
  if (field.set_text != nullptr) return field.set_text(entry, cell);
  field.set_number != nullptr ? set_number(entry, column, cell, decimal_comma)
                              : set_window(entry, column, cell, decimal_comma);
}

bool is_comment_or_blank(std::string_view line) {
  const std::string_view text = trim(line);
  return text.empty() || text.front() == '#';
}

/// Returns the delimiter of the header line: spreadsheets write semicolons if the comma is the decimal sign.
char delimiter_of(std::string_view names) {
  for (const char delimiter : {',', ';', '\t'}) {
    if (names.find(delimiter) != std::string_view::npos) return delimiter;
  }
  return ',';
}

}  // namespace

std::vector<RecordingOption> recording_options() {
  std::vector<RecordingOption> options;
  for (const ManifestField& field : kFields) {
    if (!field.said.help.empty()) options.push_back(field.said);
  }
  return options;
}

Error in_words_of_manifest(Error error) {
  error.message = with_columns_for_options(std::move(error.message));
  return error;
}

class ManifestReader::Implementation {
 public:
  Implementation(const std::filesystem::path& file, std::unique_ptr<TextSource> source)
      : name_(name_of_file(file)), folder_(file.parent_path()), lines_(std::move(source)) {}

  void read_names() {
    const std::string_view line = next_line();
    if (line.data() == nullptr) {
      throw ThrownError({"missing_column", name_ + ": contains only blank lines and comments; expected a header line "
                                                   "such as id,file,speed_m_per_s and a line for each recording"});
    }
    delimiter_ = delimiter_of(line);
    columns_ = find_manifest_columns(fields_of(line), place());
  }

  std::optional<ManifestEntry> next() {
    const std::string_view line = next_line();
    return line.data() == nullptr ? std::nullopt : std::optional(entry_from(line));
  }

  [[nodiscard]] const ManifestColumns& columns() const { return columns_; }

 private:
  [[nodiscard]] std::string place() const { return fmt::format("{}:{}", name_, lines_.number()); }

  [[nodiscard]] std::vector<std::string> fields_of(std::string_view line) const {
    auto fields = csv_fields(line, delimiter_);
    if (fields) return *std::move(fields);
    throw ThrownError({"open_quote", place() + ": a quote is not closed, or text follows a closing quote; expected "
                                               "\"...\" around a whole field, on one line"});
  }

  /// The next line that says something; without data at the end.
  std::string_view next_line() {
    try {
      for (;;) {
        const char* const line = lines_.next();
        if (line == nullptr) return {};
        if (!is_comment_or_blank(line)) return line;
      }
    } catch (const std::exception& error) {
      throw ThrownError(
          {"not_readable", fmt::format("{}: reading failed ({}); expected a text file with a line for each "
                                       "recording",
                                       place(), printable_utf8(error.what()))});
    }
  }

  ManifestEntry entry_from(std::string_view line) {
    ManifestEntry entry;
    entry.row = ++row_;
    entry.line = lines_.number();
    const std::vector<std::string> cells = fields_of(line);
    if (cells.size() != columns_.count) {
      throw ThrownError({"wrong_field_count",
                         fmt::format("{}: {} in '{}', expected {} as in the header line", place(),
                                     counted(cells.size(), "field"), printable_utf8(trim(line)), columns_.count)});
    }
    for (const ManifestColumn& column : columns_.read) {
      try {
        set_cell(entry, column, cells[column.index], delimiter_ == ';');
      } catch (const ThrownError& thrown) {
        const Error error = in_words_of_manifest(thrown.error());
        throw ThrownError({error.code, fmt::format("{}: column '{}': {}", place(), column.name, error.message)});
      }
    }
    entry.file = folder_ / entry.file;
    if (!entry.surface.empty()) entry.surface = folder_ / entry.surface;
    entry.group = entry.conditions.labels.group;
    return entry;
  }

  std::string name_;
  std::filesystem::path folder_;
  ParsedLines lines_;
  char delimiter_ = ',';
  ManifestColumns columns_;
  std::size_t row_ = 0;
};

ManifestReader::ManifestReader(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
ManifestReader::ManifestReader(ManifestReader&&) noexcept = default;
ManifestReader& ManifestReader::operator=(ManifestReader&&) noexcept = default;
ManifestReader::~ManifestReader() = default;

Result<ManifestReader> ManifestReader::open(const std::filesystem::path& file) {
  return result_of([&] {
    auto implementation = std::make_unique<Implementation>(file, TextSource::open(file));
    implementation->read_names();
    return ManifestReader(std::move(implementation));
  });
}

Result<std::optional<ManifestEntry>> ManifestReader::next() {
  return result_of([&] { return implementation_->next(); });
}

const std::vector<std::string>& ManifestReader::ignored_columns() const {
  return implementation_->columns().ignored;
}

Result<std::vector<ManifestEntry>> read_manifest_group(const std::filesystem::path& file,
                                                       const std::optional<std::string>& group) {
  return result_of([&] {
    const std::string name = name_of_file(file);
    ManifestReader rows = value_or_throw(ManifestReader::open(file));
    std::vector<ManifestEntry> entries;
    std::unordered_map<std::string, std::size_t> line_of_id;
    std::set<std::string> groups;
    while (auto entry = value_or_throw(rows.next())) {
      if (!entry->group.empty()) groups.insert(entry->group);
      if (group && entry->group != *group) continue;
      const auto [first, is_new] = line_of_id.emplace(entry->id, entry->line);
      if (!is_new) throw duplicate_id(name, *entry, first->second);
      entries.push_back(*std::move(entry));
    }
    if (!entries.empty()) return entries;
    if (!group) throw empty_manifest(name);
    if (groups.empty()) {
      throw ThrownError(
          {"unknown_group", name + ": no recording has a group; add a column 'group', or leave out --group"});
    }
    throw ThrownError({"unknown_group", fmt::format("{}: no recording of group '{}', expected one of: {}", name,
                                                    printable_utf8(*group), fmt::join(groups, ", "))});
  });
}

Result<ManifestEntry> entry_from_cells(std::vector<NamedCell> cells) {
  std::ranges::stable_sort(
      cells, [](const NamedCell& a, const NamedCell& b) { return turn_of(a.column) < turn_of(b.column); });
  ManifestEntry entry;
  for (const NamedCell& cell : cells) {
    const auto column = result_of([&] { return recognise(cell.column, 0, cell.column); });
    if (!column || !column.value()) {
      return Error{"unknown_option", fmt::format("there is no option '{}'", printable_utf8(cell.column))};
    }
    try {
      set_cell(entry, *column.value(), cell.text, false);
    } catch (const ThrownError& thrown) {
      const std::string place = cell.place.empty() ? fmt::format("column '{}'", cell.column) : cell.place;
      return Error{thrown.error().code, fmt::format("{}: {}", place, thrown.error().message)};
    }
  }
  return entry;
}

}  // namespace slipfit

namespace slipfit::reading {

std::vector<std::pair<std::string, std::string>> stated_cells(const ReadOptions& options) {
  std::vector<std::pair<std::string, std::string>> cells;
  for (const ManifestField& field : kFields) {
    if (field.cell_of == nullptr) continue;
    if (auto cell = field.cell_of(options)) cells.emplace_back(field.full_name(), *std::move(cell));
  }
  return cells;
}

}  // namespace slipfit::reading
