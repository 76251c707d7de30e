#pragma once

#include <string>

#include "drafts.hpp"
#include "recording_options.hpp"

/// A folder of recordings in place of a manifest.
struct BatchFolder {
  std::string recordings;
  std::string out;
  RecordingArguments options;
};

/// Drafts the manifest of the folder as `slipfit manifest` does, with the options in cells that are empty, into the
/// folder of the results; returns its file. Throws Failure.
std::string drafted_manifest(const BatchFolder& folder, const Tell& tell);

/// The columns of a manifest say what these options would. Throws Failure(WrongUsage) where one is given.
void refuse_recording_options(const RecordingArguments& options);
