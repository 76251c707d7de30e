#include "recording_options.hpp"

#include <fmt/format.h>

#include <functional>

#include "failure.hpp"
#include "quantities.hpp"

using slipfit::Dimension;

namespace {

/// Units are checked before the file is opened: a misspelt option is wrong usage, not a bad recording.
std::string checked_unit(const std::string& option, const std::string& unit, Dimension dimension) {
  const bool is_coefficient = dimension == Dimension::Force && slipfit::parse_unit(unit, Dimension::Dimensionless);
  const auto scale = slipfit::parse_unit(unit, dimension);
  if (!scale && !is_coefficient) {
    throw Failure(ExitCode::WrongUsage, fmt::format("{}: {}", option, scale.error().message));
  }
  return unit;
}

std::string checked_force_scale(const std::string& text) {
  if (slipfit::parse_force_scale(text)) return text;
  throw Failure(ExitCode::WrongUsage,
                fmt::format("--force-scale: bad '{}', expected newtons for a unit: '5 N/V'", text));
}

/// An option whose text is read by `read(option, text)`.
template <class Target, class Read>
CLI::Option* add_read_option(CLI::App& command, const std::string& option, Target& target, const Read& read,
                             const std::string& help) {
  const auto take = [&target, option, read](const std::string& text) { target = read(option, text); };
  return command.add_option_function<std::string>(option, take, help);
}

auto above_zero(Dimension dimension) {
  return [dimension](const std::string& option, const std::string& text) {
    return positive_quantity(option, text, dimension);
  };
}

auto unit_of(Dimension dimension) {
  return
      [dimension](const std::string& option, const std::string& text) { return checked_unit(option, text, dimension); };
}

/// What moves, what measures it and what drives it.
void add_instrument_options(CLI::App& command, slipfit::Conditions& conditions) {
  add_read_option(command, "--mass", conditions.mass_kg, above_zero(Dimension::Mass),
                  "Moving mass: 0.0307 (kg), '30.7 g'; held against k / w_n^2");
  add_read_option(command, "--sensor-bandwidth", conditions.sensor_bandwidth_Hz, above_zero(Dimension::Frequency),
                  "Bandwidth (-3 dB) of the sensor, first order: 500 (Hz), 2kHz; the fit lets its model lag by it");
  add_read_option(
      command, "--sensor-average,--averaging", conditions.sensor_average_s,
      [](const std::string&, const std::string& text) {
        return quantity_not_negative("--sensor-average", text, Dimension::Time);
      },
      "Time over which each sample is averaged: 0.002 (s), 2ms, 0 for an instant; the fit averages its model over it");
  add_read_option(command, "--sensor-resonance", conditions.sensor_resonance_Hz, above_zero(Dimension::Frequency),
                  "Natural frequency of the load cell: 800 (Hz), 2kHz");
  add_read_option(command, "--drive-period", conditions.drive_period_s, above_zero(Dimension::Time),
                  "Period of what may set the rhythm, a motor's step or an excitation: 20ms");
  add_read_option(
      command, "--force-view", conditions.force_view,
      [](const std::string&, const std::string& text) { return force_view(text); },
      "Force that the sensor sees: spring, transmitted, contact")
      ->default_str("spring");
}

}  // namespace

void add_recording_options(CLI::App& command, RecordingArguments& arguments) {
  slipfit::Conditions& conditions = arguments.conditions;
  slipfit::ReadOptions& options = arguments.options;
  command.add_option("REC", arguments.files, "Recording: text with a time and a force column")->required();
  command
      .add_option("--speed", arguments.speeds, "Driving speed: 0.01 (m/s), 10mm/s, '600 mm/min'; 60rpm with --radius")
      ->allow_extra_args(false);
  command.add_option("--speed-uncertainty", arguments.speed_uncertainty,
                     "Standard error of the speed: 0.1mm/s, or a percentage: 1%");
  command.add_option("--radius", arguments.radius, "Distance of the contact from the axis: 12mm");
  add_read_option(command, "--normal-force", conditions.normal_force_N, above_zero(Dimension::Force),
                  "Normal force: 5 (N), '41 gf'");
  add_read_option(
      command, "--zero", conditions.zero_force_N,
      [](const std::string& option, const std::string& text) { return quantity(option, text, Dimension::Force); },
      "Sensor reading at no force (N); absolute forces need it");
  add_instrument_options(command, conditions);
  add_reading_options(command, options);
  command.add_flag("--strokes{both}", arguments.strokes,
                   "Reciprocating test: each stroke is a recording; --strokes=positive, =negative for one direction");
  command.add_flag("--segments", arguments.segments, "Each stretch of one speed is a recording: a sweep in one file");
}

void add_reading_options(CLI::App& command, slipfit::ReadOptions& options) {
  command.add_option("--time-column", options.time_column, "Name or 1-based number");
  command.add_option("--force-column", options.force_column, "Name or 1-based number");
  command.add_option("--normal-force-column", options.normal_force_column, "Name or 1-based number");
  command.add_option("--speed-column", options.speed_column, "Name or 1-based number; of rpm with --radius");
  add_read_option(command, "--time-unit", options.time_unit, unit_of(Dimension::Time),
                  "Unit of the time column: ms, min");
  add_read_option(command, "--force-unit", options.force_unit, unit_of(Dimension::Force),
                  "Unit of the force column: mN, gf; 1 for a coefficient");
  add_read_option(
      command, "--force-scale", options.force_scale,
      [](const std::string&, const std::string& text) { return checked_force_scale(text); },
      "Force for a unit of what the force column holds: '5 N/V'");
  add_read_option(command, "--sample-rate", options.sample_rate_Hz, above_zero(Dimension::Frequency),
                  "Sampling rate (Hz), for a recording without a clock");
  command.add_option("--sheet", options.sheet, "Sheet of a workbook, file of a zip archive: name or 1-based number");
  command.add_option("--variable", options.variable,
                     "Variable of a .mat file, dataset or group of HDF5, group of TDMS");
  command.add_option("--step", options.step, "Step of a file that holds several (slipfit info lists them)");
  add_read_option(
      command, "--rows", options.rows, [](const std::string&, const std::string& text) { return row_range(text); },
      "A:B, rows of numbers, counted from 1");
  add_read_option(
      command, "--where", options.where, [](const std::string&, const std::string& text) { return column_value(text); },
      "COLUMN=VALUE: rows whose cell in this column (name or number) says this");
  add_read_option(
      command, "--window", options.window,
      [](const std::string&, const std::string& text) { return time_window(text); },
      "T0:T1, seconds on the recording's own clock");
}

const std::string& only_file(const RecordingArguments& arguments) {
  if (arguments.files.size() == 1) return arguments.files.front();
  throw Failure(ExitCode::WrongUsage, fmt::format("'{}' is a second file, expected one", arguments.files.at(1)));
}

slipfit::ReadOptions read_options_from(const RecordingArguments& arguments) {
  slipfit::ReadOptions options = arguments.options;
  if (arguments.strokes) {
    const auto strokes = slipfit::parse_strokes(*arguments.strokes);
    if (!strokes || arguments.segments) {
      throw Failure(ExitCode::WrongUsage,
                    strokes
                        ? "--strokes and --segments: give one of them"
                        : fmt::format("--strokes: bad '{}', expected both, positive or negative", *arguments.strokes));
    }
    options.pieces = *strokes;
  }
  if (arguments.segments) options.pieces = slipfit::Pieces::Segments;
  if (arguments.radius) options.radius_m = positive_quantity("--radius", *arguments.radius, Dimension::Length);
  return options;
}

slipfit::Conditions conditions_from(const RecordingArguments& arguments) {
  if (arguments.speeds.size() > 1) throw Failure(ExitCode::WrongUsage, "--speed: one recording has one, give it once");
  return conditions_at(arguments, arguments.speeds.empty() ? std::nullopt : std::optional(arguments.speeds.front()));
}

slipfit::Conditions conditions_at(const RecordingArguments& arguments, const std::optional<std::string>& speed) {
  slipfit::Conditions conditions = arguments.conditions;
  if (speed) {
    conditions.speed_m_per_s = driving_speed(*speed, arguments.radius);
    conditions.speed_unit = slipfit::unit_in(*speed);
  }
  if (arguments.speed_uncertainty) {
    (void)required(speed, "--speed", "the driving speed that --speed-uncertainty is of");
    conditions.speed_standard_error_m_per_s =
        speed_standard_error(*arguments.speed_uncertainty, conditions.speed_m_per_s, arguments.radius);
  }
  return conditions;
}
