#pragma once

#include <functional>
#include <string>
#include <vector>

#include "recording_options.hpp"
#include "slipfit/io/manifest_draft.hpp"
#include "slipfit/io/manifest_entry.hpp"

using Tell = std::function<void(const std::string&)>;

/// Throws Failure(BadRecording) where the draft has no recording.
void check_found(const slipfit::ManifestDraft& draft);

/// What `slipfit manifest` drafts of files and folders, at least one recording. A named file that is none throws
/// Failure(BadRecording); in a folder it is told of and left out.
slipfit::ManifestDraft draft_of(const std::vector<std::string>& paths, const slipfit::ReadOptions& options,
                                const Tell& tell);

/// The recordings of a draft, to be read with these options. Where --speed is given once for several, it is for those
/// whose file and name do not tell theirs. Throws Failure(WrongUsage) where one is left without a speed.
std::vector<slipfit::ManifestEntry> entries_of(const slipfit::ManifestDraft& draft, const RecordingArguments& arguments,
                                               const Tell& tell);
