#include "io/manifest_fields.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "io/cells.hpp"
#include "io/message.hpp"

namespace slipfit {
namespace reading {
namespace {

// What a cell of text sets, or the error that it is.

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

template <auto member>
std::optional<Error> set_text_of(ManifestEntry& entry, const std::string& cell) {
  owner_of(member, entry).*member = cell;
  return std::nullopt;
}

std::optional<Error> set_id(ManifestEntry& entry, const std::string& cell) {
  const bool has_slash = cell.find_first_of("/\\") != std::string::npos;
  const bool has_control =
      std::ranges::any_of(cell, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; });
  if (has_slash || has_control || cell.starts_with("group:")) {
    return refusal("bad_id", cell, "a name without slash or control character that does not start with 'group:'");
  }
  entry.id = to_utf8(cell);
  return std::nullopt;
}

template <auto Labels::*target>
std::optional<Error> set_label(ManifestEntry& entry, const std::string& cell) {
  entry.conditions.labels.*target = to_utf8(cell);
  return std::nullopt;
}

std::optional<Error> set_force_view(ManifestEntry& entry, const std::string& cell) {
  constexpr auto kViews = std::to_array<std::pair<std::string_view, ForceView>>(
      {{"spring", ForceView::Spring}, {"transmitted", ForceView::Transmitted}, {"contact", ForceView::Contact}});
  const auto* const view = std::ranges::find_if(kViews, [&](const auto& v) { return v.first == cell; });
  if (view == kViews.end()) return refusal("unknown_force_view", cell, "spring, transmitted or contact");
  entry.conditions.force_view = view->second;
  return std::nullopt;
}

std::optional<Error> set_drift(ManifestEntry& entry, const std::string& cell) {
  constexpr auto kReadings = std::to_array<std::pair<std::string_view, LevelReading>>(
      {{"sensor", LevelReading::Sensor}, {"friction", LevelReading::Friction}, {"none", LevelReading::None}});
  const auto* const reading =
      std::find_if(kReadings.begin(), kReadings.end(), [&](const auto& r) { return r.first == cell; });
  if (reading == kReadings.end()) return refusal("unknown_drift", cell, "sensor, friction or none");
  entry.conditions.drift = reading->second;
  return std::nullopt;
}

/// "4, 200 Hz": order and corner of a Butterworth response.
std::optional<Error> set_sensor_filter(ManifestEntry& entry, const std::string& cell) {
  const std::size_t comma = cell.find_first_of(",;");
  const double order = plain_number(std::string_view(cell).substr(0, comma), false);
  const bool is_order = order >= 1.0 && order <= static_cast<double>(kHighestFilterOrder) && order == std::floor(order);
  const Result<double> corner_Hz = comma == std::string::npos
                                       ? Result<double>(Error{"bad_sensor_filter", ""})
                                       : parse_quantity(std::string_view(cell).substr(comma + 1), Dimension::Frequency);
  if (!is_order || !corner_Hz || !(corner_Hz.value() > 0.0)) {
    return refusal("bad_sensor_filter", cell, "an order from 1 to 8 and a corner frequency, such as '4, 200 Hz'");
  }
  if (entry.conditions.sensor_bandwidth_Hz) {
    return refusal("conflicting_sensor", cell, "either a bandwidth (first order) or a filter");
  }
  entry.conditions.sensor_bandwidth_Hz = corner_Hz.value();
  entry.conditions.sensor_filter_order = static_cast<std::size_t>(order);
  return std::nullopt;
}

template <Dimension dimension, std::optional<std::string> ReadOptions::*target>
std::optional<Error> set_unit(ManifestEntry& entry, const std::string& cell) {
  const Result<UnitScale> unit = parse_unit(cell, dimension);
  const bool is_other = dimension == Dimension::Force &&
                        (parse_unit(cell, Dimension::Dimensionless) || parse_unit(cell, Dimension::Torque));
  if (!unit && !is_other) return Error{"unknown_unit", printable(unit.error().message)};
  entry.options.*target = cell;
  return std::nullopt;
}

std::optional<Error> set_step(ManifestEntry& entry, const std::string& cell) {
  const double step = plain_number(cell, false);
  if (!(step >= 0.0 && step < 1e9 && step == std::floor(step)))
    return refusal("bad_step", cell, "the number of a step as listed by slipfit info");
  entry.options.step = static_cast<std::size_t>(step);
  return std::nullopt;
}

std::optional<Error> set_rows(ManifestEntry& entry, const std::string& cell) {
  entry.options.rows = parse_row_range(cell);
  return entry.options.rows ? std::nullopt : refusal("bad_rows", cell, "A:B with 1 <= A < B, rows counted from 1");
}

std::optional<Error> set_where(ManifestEntry& entry, const std::string& cell) {
  entry.options.where = parse_column_value(cell);
  return entry.options.where ? std::nullopt : refusal("bad_where", cell, "COLUMN=VALUE");
}

/// Strokes or segments.
std::optional<Error> set_pieces(ManifestEntry& entry, const std::string& cell, Pieces pieces) {
  if (entry.options.pieces != Pieces::One) return refusal("conflicting_pieces", cell, "either strokes or segments");
  entry.options.pieces = pieces;
  return std::nullopt;
}

std::optional<Error> set_strokes(ManifestEntry& entry, const std::string& cell) {
  const auto strokes = parse_strokes(cell);
  return strokes ? set_pieces(entry, cell, *strokes) : refusal("bad_strokes", cell, "both, positive or negative");
}

std::optional<Error> set_segments(ManifestEntry& entry, const std::string& cell) {
  if (cell == "no") return std::nullopt;
  return cell == "yes" ? set_pieces(entry, cell, Pieces::Segments) : refusal("bad_segments", cell, "yes or no");
}

std::optional<Error> set_force_scale(ManifestEntry& entry, const std::string& cell) {
  entry.options.force_scale = cell;
  return parse_force_scale(cell) ? std::nullopt : refusal("unknown_unit", cell, "newtons per unit, such as 5 N/V");
}

using Bound = ManifestField::Bound;
using Need = ManifestField::Need;
using Of = RecordingOption::Of;

constexpr std::string_view kColumnHelp = "Name or 1-based number";

constexpr ManifestField text_field(RecordingOption said, ManifestField::SetText* set_text, Need need = Need::Nothing) {
  return {.said = said, .set_text = set_text, .need = need};
}

constexpr ManifestField number_field(RecordingOption said, std::string_view suffix, Dimension dimension, Bound bound,
                                     ManifestField::SetNumber* set_number, Need need = Need::Nothing) {
  return {said, suffix, dimension, bound, set_number, nullptr, need};
}

// In the order of the help.
constexpr std::array kFields = std::to_array<ManifestField>({
    text_field({"id"}, set_id, Need::Value),
    text_field({"file"}, set_text_of<&ManifestEntry::file>, Need::Value),
    number_field({"speed", "--speed", "Driving speed: 0.01 (m/s), 10mm/s, '600 mm/min'; 60rpm with --radius"},
                 "_m_per_s", Dimension::Speed, Bound::AboveZero, set_number_of<&Conditions::speed_m_per_s>,
                 Need::Column),
    number_field({"speed_se", "--speed-uncertainty", "Standard error of the speed: 0.1mm/s, or a percentage: 1%"},
                 "_m_per_s", Dimension::Speed, Bound::NotNegative,
                 set_number_of<&Conditions::speed_standard_error_m_per_s>),
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
    text_field({"time_column", "--time-column", kColumnHelp, Of::Reading}, set_text_of<&ReadOptions::time_column>),
    text_field({"force_column", "--force-column", kColumnHelp, Of::Reading}, set_text_of<&ReadOptions::force_column>),
    text_field({"normal_force_column", "--normal-force-column", kColumnHelp, Of::Reading},
               set_text_of<&ReadOptions::normal_force_column>),
    text_field(
        {"speed_column", "--speed-column", "Name or 1-based number; a column in rpm needs --radius", Of::Reading},
        set_text_of<&ReadOptions::speed_column>),
    number_field(
        {"radius", "--radius",
         "Distance of the contact from the axis of rotation: 12mm; for a torque or a rotational speed", Of::Reading},
        "_m", Dimension::Length, Bound::AboveZero, set_number_of<&ReadOptions::radius_m>),
    text_field({"time_unit", "--time-unit", "Unit of the time column: ms, min", Of::Reading},
               set_unit<Dimension::Time, &ReadOptions::time_unit>),
    text_field({"force_unit", "--force-unit",
                "Unit of the force column: mN, kgf; 1 for a coefficient, 'N m' for a torque", Of::Reading},
               set_unit<Dimension::Force, &ReadOptions::force_unit>),
    text_field({"force_scale", "--force-scale", "Force per unit of the force column: '5 N/V'", Of::Reading},
               set_force_scale),
    number_field(
        {"sample_rate", "--sample-rate", "Sampling rate (Hz) of a recording without a time column", Of::Reading}, "_Hz",
        Dimension::Frequency, Bound::AboveZero, set_number_of<&ReadOptions::sample_rate_Hz>),
    text_field(
        {"sheet", "--sheet", "Sheet of a workbook or file in a zip archive: name or 1-based number", Of::Reading},
        set_text_of<&ReadOptions::sheet>),
    text_field({"variable", "--variable",
                "Variable of a .mat file, dataset or group of an HDF5 file, group of a TDMS file", Of::Reading},
               set_text_of<&ReadOptions::variable>),
    text_field({"step", "--step", "Step of a file with several steps (slipfit info lists them)", Of::Reading},
               set_step),
    text_field({"rows", "--rows", "A:B, range of rows of numbers, counted from 1", Of::Reading}, set_rows),
    text_field(
        {"where", "--where", "COLUMN=VALUE: only rows with this value in this column (name or number)", Of::Reading},
        set_where),
    number_field({"window", "--window", "T0:T1, part of the recording, in seconds of its own clock", Of::Reading}, "_s",
                 Dimension::Time, Bound::None, nullptr),
    text_field(
        {"strokes", "--strokes{both}",
         "Reciprocating test: each stroke becomes a recording; --strokes=positive or =negative selects one direction",
         Of::Pieces},
        set_strokes),
    text_field({"segments", "--segments{yes}",
                "Each section of constant speed becomes a recording: a sweep in one file", Of::Pieces},
               set_segments),
});

}  // namespace

std::span<const ManifestField> manifest_fields() {
  return kFields;
}

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

}  // namespace reading

std::vector<RecordingOption> recording_options() {
  std::vector<RecordingOption> options;
  for (const reading::ManifestField& field : reading::kFields) {
    if (!field.said.help.empty()) options.push_back(field.said);
  }
  return options;
}

}  // namespace slipfit
