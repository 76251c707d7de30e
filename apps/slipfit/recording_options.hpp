#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "slipfit/io/manifest_entry.hpp"

/// Properties of a recording that the user states; the same for every command that reads one.
struct RecordingArguments {
  std::vector<std::string> files;
  std::vector<std::string> speeds;          ///< one, or one for each recording
  std::map<std::string, std::string> said;  ///< as typed, by the column of a manifest; empty: not given
  bool speed_is_optional = false;
};

/// Adds the options of a recording that are wanted.
void add_options_where(CLI::App& command, RecordingArguments& arguments,
                       const std::function<bool(const slipfit::RecordingOption&)>& is_wanted);

/// REC and all options about it.
void add_recording_options(CLI::App& command, RecordingArguments& arguments);

/// Returns the options that were given, including --speed.
std::vector<slipfit::RecordingOption> given_options(const RecordingArguments& arguments);

/// Returns the file of a command that takes one. Throws Failure(WrongUsage).
const std::string& only_file(const RecordingArguments& arguments);

/// Returns the entry of a recording at one of the speeds; without one a column must contain it. Throws
/// Failure(WrongUsage) for a text that is not a value of its option.
slipfit::ManifestEntry entry_at(const RecordingArguments& arguments, const std::optional<std::string>& speed);

/// Returns the entry at the one speed that is given, if any. Throws Failure(WrongUsage), also if several are given.
slipfit::ManifestEntry entry_from(const RecordingArguments& arguments);

/// Returns the options about the file, without the speed. Throws Failure(WrongUsage).
slipfit::ReadOptions read_options_from(const RecordingArguments& arguments);
