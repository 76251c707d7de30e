#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "batch/files.hpp"
#include "batch/result_log.hpp"
#include "batch/run_file.hpp"
#include "batch/tables.hpp"
#include "batch/work_list.hpp"

namespace slipfit::batch {

/// Keeps other processes out of a folder as long as it lives. The kernel releases it with the process, so that the
/// lock of a dead one is void; the file `lock` only says whose it is.
class FolderLock {
 public:
  /// Makes the folder where it is missing. Errors: folder_in_use, cannot_write, folder_of_another_batch where the file
  /// `lock` was written by another program.
  static FolderLock take(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(FolderLock&&) noexcept = default;
  FolderLock& operator=(FolderLock&&) noexcept = default;
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  FolderLock(std::filesystem::path file, FileHandle handle) : file_(std::move(file)), handle_(std::move(handle)) {}

  std::filesystem::path file_;
  FileHandle handle_;
};

/// The record of the batch in a folder that `now` continues, if any. Errors: folder_of_another_batch where it holds
/// results of another batch, or files of a batch's names that no batch wrote; cannot_write where they are symbolic
/// links, which are not followed.
std::optional<RunRecord> check_folder(const std::filesystem::path& folder, const RunRecord& now);

/// Returns true if the folder holds a result of the batch of this record.
bool has_results(const std::filesystem::path& folder, const RunRecord& record);

// The files of a finished batch: results.jsonl, summary.csv and failures.csv, in the manifest's order.

/// A line of the log, and what the manifest says about its recording or group.
struct LoggedResult {
  std::size_t slot = 0;
  SummaryKey key;
  bool has_failed = false;
  std::string line;
};

/// Calls `use` with what the log holds, in the manifest's order, each group after the last of its recordings. Errors:
/// also those of ManifestReader, not_readable.
void for_each_result(const std::filesystem::path& manifest, const WorkList& list, const ResultLog& log,
                     const std::function<void(const LoggedResult&)>& use);

/// Writes the files; each replaces the old one when all are complete.
class FinalFiles {
 public:
  explicit FinalFiles(const std::filesystem::path& folder);

  /// Lines without their ends.
  void add_result(const std::string& document, const std::string& summary);
  void add_failure(const std::string& failure, const std::string& summary);
  /// Finishes all files and returns their digests. Errors: cannot_write, of any earlier step.
  FileDigests finish();

 private:
  Replacement results_;
  Replacement summary_;
  Replacement failures_;
};

/// Writes the final files from the log.
FileDigests write_final_files(const std::filesystem::path& folder, const std::filesystem::path& manifest,
                              const WorkList& list, const ResultLog& log);

}  // namespace slipfit::batch
