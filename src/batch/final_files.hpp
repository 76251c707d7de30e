#pragma once

#include <filesystem>
#include <string>

#include "batch/files.hpp"
#include "batch/result_log.hpp"
#include "batch/run_file.hpp"
#include "batch/work_list.hpp"

namespace slipfit::batch {

/// results.jsonl, summary.csv and failures.csv in the manifest's order, each in place of the old one when all are
/// complete.
class FinalFiles {
 public:
  explicit FinalFiles(const std::filesystem::path& folder);

  /// Lines without their ends.
  void add_result(const std::string& document, const std::string& summary);
  void add_failure(const std::string& failure, const std::string& summary);
  /// Errors: cannot_write, of anything before.
  FileDigests finish();

 private:
  Replacement results_;
  Replacement summary_;
  Replacement failures_;
};

/// From what the log holds.
FileDigests write_final_files(const std::filesystem::path& folder, const std::filesystem::path& manifest,
                              const WorkList& list, const ResultLog& log);

}  // namespace slipfit::batch
