#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "batch/files.hpp"
#include "batch/result_log.hpp"
#include "batch/run_file.hpp"
#include "batch/work_list.hpp"
#include "slipfit/core/result.hpp"

namespace slipfit::batch {

/// results.jsonl, summary.csv and failures.csv in the manifest's order, each in place of the old one when all are
/// complete.
class FinalFiles {
 public:
  static Result<FinalFiles> open(const std::filesystem::path& folder);

  /// Lines without their ends.
  std::optional<Error> add_result(const std::string& document, const std::string& summary);
  std::optional<Error> add_failure(const std::string& failure, const std::string& summary);
  Result<FileDigests> finish();

 private:
  FinalFiles(Replacement results, Replacement summary, Replacement failures)
      : results_(std::move(results)), summary_(std::move(summary)), failures_(std::move(failures)) {}

  Replacement results_;
  Replacement summary_;
  Replacement failures_;
};

/// From what came in, in whatever order. Slots without a line are left out.
Result<FileDigests> write_final_files(const std::filesystem::path& folder, const std::filesystem::path& manifest,
                                      const WorkList& list, const ResultLog& log);

}  // namespace slipfit::batch
