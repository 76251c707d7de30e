#pragma once

#include <optional>
#include <string>
#include <vector>

#include "output.hpp"
#include "slipfit/fit/fit.hpp"
#include "slipfit/io/manifest_entry.hpp"
#include "slipfit/sweep.hpp"

/// A joint fit: one parameter set for several recordings.
struct SweepArguments {
  std::string name;  ///< the document's id
  DocumentOptions document;
  std::string manifest;  ///< empty: none, the recordings were named one by one
  std::vector<slipfit::ManifestEntry> entries;
};

/// Shows the steps on a terminal: some seconds for a dozen recordings.
slipfit::SweepAnalysis analyze_with_progress(const std::vector<slipfit::SweepEntry>& entries,
                                             slipfit::FitOptions options, const DocumentOptions& document);

/// Writes the documents of a sweep, whose id is `name`, and their files. Throws Failure.
void write_sweep(const std::string& name, const DocumentOptions& document,
                 const std::vector<slipfit::SweepEntry>& entries, const slipfit::SweepAnalysis& sweep);

/// Returns the recordings of a manifest, of its group, or only these ids. Throws Failure(WrongUsage).
std::vector<slipfit::ManifestEntry> manifest_entries(const std::string& manifest,
                                                     const std::optional<std::string>& group,
                                                     const std::vector<std::string>& only);

/// Reads the recordings, fits them together, writes the result. Throws Failure.
void run_sweep(const SweepArguments& arguments, const slipfit::FitOptions& options);
