#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "slipfit/batch/options.hpp"
#include "slipfit/core/digest.hpp"

namespace slipfit::batch {

/// Digests of the files of a finished batch as text; they reveal a damaged file.
struct FileDigests {
  std::string results, summary, failures;
};

/// The contents of run.json: what was run, and how far it got.
struct RunRecord {  // NOLINT(bugprone-exception-escape): to move JSON throws nothing
  std::string version;
  std::string build;      ///< build_of_program(), or "unknown": of a program that did not write it
  std::string processor;  ///< processor_of_machine() of all machines that worked on it, separated by "; "
  std::string manifest;
  std::string manifest_digest;
  nlohmann::ordered_json options;  ///< what changes the results
  Shard shard;
  std::size_t jobs = 1;
  double timeout_s = 0.0;
  std::size_t rows = 0;  ///< of the whole manifest
  BatchProgress progress;
  std::string started;  ///< UTC, ISO 8601
  bool finished = false;
  FileDigests digests;  ///< once it is finished
};

/// Returns the record of a run that starts now.
RunRecord begin_record(const BatchOptions& options, const Digest& manifest_digest, std::size_t rows);

/// Returns the processors of both records, each once.
std::string processors_of(const RunRecord& a, const RunRecord& b);

void write_record(const std::filesystem::path& folder, const RunRecord& record);

/// Reads the record of a folder; empty if it has none. The error is folder_of_another_batch if no batch wrote it.
std::optional<RunRecord> read_record(const std::filesystem::path& folder);

/// Returns the reason why `now` cannot continue the run `before` ("the manifest has changed"), or nothing.
std::optional<std::string> difference(const RunRecord& before, const RunRecord& now);

}  // namespace slipfit::batch
