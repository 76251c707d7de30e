#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "slipfit/core/recording.hpp"
#include "slipfit/io/recording_reader.hpp"

/// What the user types about a recording, as typed; the same for every command that reads one.
struct RecordingArguments {
  std::string file;
  std::optional<std::string> speed;
  std::optional<std::string> speed_uncertainty;
  std::optional<std::string> radius;
  std::optional<std::string> normal_force;
  std::optional<std::string> zero;
  std::optional<std::string> sensor_bandwidth;
  std::optional<std::string> drive_period;
  std::optional<std::string> sensor_resonance;
  std::optional<std::string> mass;
  std::string force_view = "spring";
  std::optional<std::string> time_column;
  std::optional<std::string> force_column;
  std::optional<std::string> time_unit;
  std::optional<std::string> force_unit;
  std::optional<std::string> sample_rate;
  std::optional<std::string> window;
};

void add_recording_options(CLI::App& command, RecordingArguments& arguments);

/// The same in SI. Each throws Failure(WrongUsage).
slipfit::Conditions conditions_from(const RecordingArguments& arguments);
slipfit::ReadOptions read_options_from(const RecordingArguments& arguments);
