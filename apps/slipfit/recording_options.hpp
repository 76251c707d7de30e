#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "slipfit/core/recording.hpp"
#include "slipfit/io/read_options.hpp"

/// What the user says about a recording; the same for every command that reads one.
struct RecordingArguments {
  std::vector<std::string> files;
  slipfit::Conditions conditions;  ///< without the speed
  slipfit::ReadOptions options;
  // As typed, because a rotation needs the radius:
  std::vector<std::string> speeds;
  std::optional<std::string> speed_uncertainty;
  std::optional<std::string> radius;
  std::optional<std::string> strokes;
  bool segments = false;
};

/// REC and the options about it. Text that is no value of its
/// option throws Failure(WrongUsage).
void add_recording_options(CLI::App& command, RecordingArguments& arguments);

/// What `ReadOptions` holds, but for the radius: which columns, units and part of the file to read.
void add_reading_options(CLI::App& command, slipfit::ReadOptions& options);

/// Of a command that takes one. Throws Failure(WrongUsage).
const std::string& only_file(const RecordingArguments& arguments);

/// With the radius, strokes and segments. Throws Failure(WrongUsage).
slipfit::ReadOptions read_options_from(const RecordingArguments& arguments);

/// With the speed, 0 where a column must tell it. Throws Failure(WrongUsage), also where several speeds are given.
slipfit::Conditions conditions_from(const RecordingArguments& arguments);

/// With this one of the speeds; 0 without one. Throws Failure(WrongUsage).
slipfit::Conditions conditions_at(const RecordingArguments& arguments, const std::optional<std::string>& speed);
