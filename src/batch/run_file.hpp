#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "slipfit/batch/options.hpp"
#include "slipfit/core/digest.hpp"

namespace slipfit::batch {

/// Of the files of a finished batch, as text; by them a damaged one is known.
struct FileDigests {
  std::string results, summary, failures;
};

/// JSON as text.
struct JsonText {
  std::string text;
  friend bool operator==(const JsonText&, const JsonText&) = default;
};

/// What run.json says: what was run, and how far it came.
struct RunRecord {
  std::string version;
  std::string build;      ///< build_of_program(), or "unknown": of a program that did not write it
  std::string processor;  ///< processor_of_machine() of all machines that worked on it, separated by "; "
  std::string manifest;
  std::string manifest_digest;
  JsonText options;  ///< what changes the results
  Shard shard;
  std::size_t jobs = 1;
  double timeout_s = 0.0;
  std::size_t rows = 0;  ///< of the whole manifest
  BatchProgress progress;
  std::string started;  ///< UTC, ISO 8601
  bool finished = false;
  FileDigests digests;  ///< once it is finished
};

/// Of a run that begins now.
RunRecord begin_record(const BatchOptions& options, const Digest& manifest_digest, std::size_t rows);

/// Those of both, each once.
std::string processors_of(const RunRecord& a, const RunRecord& b);

void write_record(const std::filesystem::path& folder, const RunRecord& record);

/// Nothing where the folder has none. Error: folder_of_another_batch where no batch wrote it.
std::optional<RunRecord> read_record(const std::filesystem::path& folder);

/// What keeps `now` from continuing what `before` began ("the manifest has changed"), or nothing.
std::optional<std::string> difference(const RunRecord& before, const RunRecord& now);

}  // namespace slipfit::batch
