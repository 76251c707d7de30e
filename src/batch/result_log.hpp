#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "batch/files.hpp"
#include "batch/run_file.hpp"
#include "batch/tables.hpp"
#include "batch/work_list.hpp"
#include "slipfit/core/result.hpp"

// The results in the order of finishing: results.jsonl and failures.csv, and the file `journal`, which exists until the
// batch is finished:
//   begin SLOT        a fit begins; where its process dies nothing follows
//   done SLOT DIGEST  of the line in results.jsonl, by which a damaged line is known
//   end SLOT          it failed, or was stopped

namespace slipfit::batch {

/// The results of an earlier run that a folder contains.
struct FoundResults {
  explicit FoundResults(std::size_t slots) : tries(slots, 0) {}

  struct Line {
    std::size_t slot = 0;
    std::uint64_t offset = 0;
    Digest digest;
  };
  std::vector<Line> lines;           ///< as they were written, by the journal or by the digest in run.json
  std::vector<unsigned char> tries;  ///< of each slot: fits whose process died
  std::uint64_t size = 0;            ///< of results.jsonl up to the end of the last whole line
  std::size_t damaged = 0;           ///< results that were written and are not there as they were
};

FoundResults find_results(const std::filesystem::path& folder, const RunRecord& before, const WorkList& list);

/// Writes the journal, which replaces that of an earlier run.
void write_journal(const std::filesystem::path& folder, const FoundResults& found);
void remove_journal(const std::filesystem::path& folder);

class ResultLog {
 public:
  /// Keeps the results that were found; failures are tried again.
  ResultLog(const std::filesystem::path& folder, FoundResults found);

  /// A fit begins. Called in the process that fits.
  void begin(std::size_t slot);
  void add_result(std::size_t slot, std::string_view document);
  void add_failure(std::size_t slot, const std::string& id, const Error& failure);
  /// The fit was stopped, or brought nothing new.
  void add_end(std::size_t slot);
  /// Waits until the disk has what was added before.
  void sync();
  /// The first error of what was done: cannot_write. Nothing is written after it.
  void throw_error() const;

  enum class Kind : unsigned char { Nothing, Result, Failure };
  [[nodiscard]] Kind kind_of(std::size_t slot) const { return kinds_[slot]; }
  [[nodiscard]] bool has_result(std::size_t slot) const { return kind_of(slot) == Kind::Result; }
  /// The line of a slot that has one.
  [[nodiscard]] Result<std::string> line_of(std::size_t slot) const;
  /// Fits in runs before whose process died.
  [[nodiscard]] unsigned tries_of(std::size_t slot) const { return tries_[slot]; }

 private:
  LineFile results_;
  LineFile failures_;
  LineFile journal_;
  std::vector<std::uint64_t> offsets_;  ///< of each slot's line
  std::vector<Kind> kinds_;
  std::vector<unsigned char> tries_;
};

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

/// results.jsonl, summary.csv and failures.csv in the manifest's order, each in place of the old one when all are
/// complete.
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
