#include "recording_options.hpp"

#include <fmt/format.h>

#include "failure.hpp"
#include "quantities.hpp"

using slipfit::Dimension;

namespace {

/// Units are checked before the file is opened: a misspelt option is wrong usage, not a bad recording.
void check_unit(const std::string& option, const std::string& unit, Dimension dimension) {
  const auto scale = slipfit::parse_unit(unit, dimension);
  if (!scale) throw Failure(ExitCode::WrongUsage, fmt::format("{}: {}", option, scale.error().message));
}

void check_force_unit(const std::string& unit) {
  if (slipfit::parse_unit(unit, Dimension::Dimensionless)) return;
  check_unit("--force-unit", unit, Dimension::Force);
}

}  // namespace

void add_recording_options(CLI::App& command, RecordingArguments& arguments) {
  command.add_option("REC", arguments.file, "Recording: text with a time and a force column")->required();
  command.add_option("--speed", arguments.speed,
                     "Driving speed: 0.01 (m/s), 10mm/s, '600 mm/min'; 60rpm with --radius");
  command.add_option("--speed-uncertainty", arguments.speed_uncertainty,
                     "Standard error of the speed: 0.1mm/s, or a percentage: 1%");
  command.add_option("--radius", arguments.radius, "Distance of the contact from the axis: 12mm");
  command.add_option("--normal-force", arguments.normal_force, "Normal force: 5 (N), '41 gf'");
  command.add_option("--zero", arguments.zero, "Sensor reading at no force (N); absolute forces need it");
  command.add_option("--mass", arguments.mass, "Moving mass: 0.0307 (kg), '30.7 g'; held against k / w_n^2");
  command.add_option("--sensor-bandwidth", arguments.sensor_bandwidth,
                     "Bandwidth (-3 dB) of the sensor, first order: 500 (Hz), 2kHz; the fit lets its model lag by it");
  command.add_option("--sensor-resonance", arguments.sensor_resonance,
                     "Natural frequency of the load cell: 800 (Hz), 2kHz");
  command.add_option("--force-view", arguments.force_view, "Force that the sensor sees: spring, transmitted, contact")
      ->capture_default_str();
  command.add_option("--time-column", arguments.time_column, "Name or 1-based number");
  command.add_option("--force-column", arguments.force_column, "Name or 1-based number");
  command.add_option("--time-unit", arguments.time_unit, "Unit of the time column: ms, min");
  command.add_option("--force-unit", arguments.force_unit, "Unit of the force column: mN, gf; 1 for a coefficient");
  command.add_option("--sample-rate", arguments.sample_rate, "Sampling rate (Hz), for a recording without a clock");
  command.add_option("--window", arguments.window, "T0:T1, seconds on the recording's own clock");
}

slipfit::Conditions conditions_from(const RecordingArguments& arguments) {
  if (!arguments.speed) {
    throw Failure(ExitCode::WrongUsage, "--speed is missing: give the driving speed, for example --speed 10mm/s");
  }
  slipfit::Conditions conditions;
  conditions.speed_m_per_s = driving_speed(*arguments.speed, arguments.radius);
  conditions.speed_unit = slipfit::unit_in(*arguments.speed);
  if (arguments.radius) (void)positive_quantity("--radius", *arguments.radius, Dimension::Length);
  if (arguments.speed_uncertainty) {
    conditions.speed_standard_error_m_per_s =
        speed_standard_error(*arguments.speed_uncertainty, conditions.speed_m_per_s, arguments.radius);
  }
  if (arguments.normal_force) {
    conditions.normal_force_N = positive_quantity("--normal-force", *arguments.normal_force, Dimension::Force);
  }
  if (arguments.mass) conditions.mass_kg = positive_quantity("--mass", *arguments.mass, Dimension::Mass);
  if (arguments.sensor_bandwidth) {
    conditions.sensor_bandwidth_Hz =
        positive_quantity("--sensor-bandwidth", *arguments.sensor_bandwidth, Dimension::Frequency);
  }
  if (arguments.sensor_resonance) {
    conditions.sensor_resonance_Hz =
        positive_quantity("--sensor-resonance", *arguments.sensor_resonance, Dimension::Frequency);
  }
  if (arguments.zero) conditions.zero_force_N = quantity("--zero", *arguments.zero, Dimension::Force);
  conditions.force_view = force_view(arguments.force_view);
  return conditions;
}

slipfit::ReadOptions read_options_from(const RecordingArguments& arguments) {
  slipfit::ReadOptions options;
  options.time_column = arguments.time_column;
  options.force_column = arguments.force_column;
  options.time_unit = arguments.time_unit;
  options.force_unit = arguments.force_unit;
  if (options.time_unit) check_unit("--time-unit", *options.time_unit, Dimension::Time);
  if (options.force_unit) check_force_unit(*options.force_unit);
  if (arguments.sample_rate) {
    options.sample_rate_Hz = positive_quantity("--sample-rate", *arguments.sample_rate, Dimension::Frequency);
  }
  if (arguments.window) options.window = time_window(*arguments.window);
  return options;
}
