#pragma once

#include <optional>
#include <string>
#include <vector>

#include "output.hpp"
#include "recording_options.hpp"
#include "slipfit/io/manifest_draft.hpp"
#include "slipfit/io/manifest_entry.hpp"

/// Returns true if the header line of a file is that of a manifest.
bool is_manifest(const std::string& file);

/// Returns true if the paths name a manifest: a single file that is one, or that is no recording either when it is read
/// with these options: its errors are then those of a manifest.
bool names_manifest(const std::vector<std::string>& paths, const slipfit::ReadOptions& options = {});

/// Returns the recordings of a manifest, of its group, or only these ids. Throws Failure(WrongUsage).
std::vector<slipfit::ManifestEntry> manifest_entries(const std::string& manifest,
                                                     const std::optional<std::string>& group,
                                                     const std::vector<std::string>& only);

/// Throws Failure(BadRecording) where the draft has no recording.
void check_found(const slipfit::ManifestDraft& draft);

/// Drafts files and folders like `slipfit manifest`, at least one recording. A named file that is not a recording
/// throws Failure(BadRecording); in a folder it is reported and left out.
slipfit::ManifestDraft draft_of(const std::vector<std::string>& paths, const slipfit::ReadOptions& options,
                                const DocumentOptions& document);

/// Says where a stated speed or load is used instead of another one that the file or its name gives.
void notify_of_replaced(const slipfit::Conditions& stated, const slipfit::DraftEntry& drafted,
                        const DocumentOptions& document);

/// The recordings of a draft, to be read with these options: a stated speed and load count, those of the file or its
/// name fill in what is not stated. Throws Failure(WrongUsage) where one is left without a speed.
std::vector<slipfit::ManifestEntry> entries_of(const slipfit::ManifestDraft& draft, const RecordingArguments& arguments,
                                               const DocumentOptions& document);
