#pragma once

#include <string>
#include <vector>

#include "drafts.hpp"
#include "recording_options.hpp"

/// Files and folders of recordings without a manifest.
struct BatchFolder {
  std::vector<std::string> recordings;
  std::string out;
  RecordingArguments options;
};

/// Drafts the manifest of the recordings as `slipfit manifest` does, with what the options state, into the folder of
/// the results; returns its file. Throws Failure.
std::string drafted_manifest(const BatchFolder& folder, const Notify& notify);

/// The columns of a manifest say what these options would. Throws Failure(WrongUsage) where one is given.
void refuse_recording_options(const RecordingArguments& options);
