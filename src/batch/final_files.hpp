#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include "batch/files.hpp"
#include "batch/result_log.hpp"
#include "batch/run_file.hpp"
#include "batch/tables.hpp"
#include "batch/work_list.hpp"

// The files of a finished batch: results.jsonl, summary.csv and failures.csv, in the manifest's order.

namespace slipfit::batch {

/// A line of the log, and what the manifest says about its recording or group.
struct LoggedResult {
  std::size_t slot = 0;
  SummaryKey key;
  bool has_failed = false;
  std::string line;
};

/// Calls `use` with what the log holds, in the manifest's order, each group behind the last of its recordings. Errors:
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
