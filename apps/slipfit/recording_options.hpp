#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "slipfit/io/manifest_entry.hpp"

/// What the user says about a recording; the same for every command that reads one.
struct RecordingArguments {
  std::vector<std::string> files;
  std::vector<std::string> speeds;          ///< one, or one for each recording
  std::map<std::string, std::string> said;  ///< as typed, by the column of a manifest; empty: not given
};

/// Those options about a recording that are wanted.
void add_options_where(CLI::App& command, RecordingArguments& arguments,
                       const std::function<bool(const slipfit::RecordingOption&)>& is_wanted);

/// REC and all options about it.
void add_recording_options(CLI::App& command, RecordingArguments& arguments);

/// Those that were given, with --speed.
std::vector<slipfit::RecordingOption> given_options(const RecordingArguments& arguments);

/// Of a command that takes one. Throws Failure(WrongUsage).
const std::string& only_file(const RecordingArguments& arguments);

/// How to read a recording at this one of the speeds; without one a column must tell it. Throws Failure(WrongUsage) for
/// text that is no value of its option.
slipfit::ManifestEntry entry_at(const RecordingArguments& arguments, const std::optional<std::string>& speed);

/// At the one speed that is given, if any. Throws Failure(WrongUsage), also where several are given.
slipfit::ManifestEntry entry_from(const RecordingArguments& arguments);

/// What the options say of the file; a speed has no part in it. Throws Failure(WrongUsage).
slipfit::ReadOptions read_options_from(const RecordingArguments& arguments);
