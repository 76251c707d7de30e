#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "batch/files.hpp"
#include "batch/id_index.hpp"
#include "batch/run_file.hpp"
#include "slipfit/core/result.hpp"

// The results as they come in: results.jsonl and failures.csv in the order of finishing, and the file `journal`, which
// lives until the batch is finished:
//   begin SLOT        a fit begins; where its process dies nothing follows
//   done SLOT DIGEST  of the line in results.jsonl, by which a damaged line is known
//   end SLOT          it failed, or was stopped

namespace slipfit::batch {

/// What a folder holds of a batch that began before. Slots are those of the work list.
struct FoundResults {
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

/// Nothing found.
FoundResults no_results(std::size_t slots);
FoundResults find_results(const std::filesystem::path& folder, const RunRecord& before, std::size_t slots,
                          const IdIndex& slot_of_id);

/// In place of the one of a run before.
std::optional<Error> write_journal(const std::filesystem::path& folder, const FoundResults& found);
void remove_journal(const std::filesystem::path& folder);

class ResultLog {
 public:
  /// Keeps what was found; failures are tried again.
  static Result<std::unique_ptr<ResultLog>> open(const std::filesystem::path& folder, FoundResults found);

  /// Called in the process that fits.
  std::optional<Error> begin(std::size_t slot);
  std::optional<Error> add_result(std::size_t slot, std::string_view document);
  std::optional<Error> add_failure(std::size_t slot, const std::string& id, const Error& failure);
  /// The fit was stopped, or brought nothing new.
  std::optional<Error> add_end(std::size_t slot);
  /// Waits until the disk has what was added before.
  std::optional<Error> sync();

  enum class Kind : unsigned char { Nothing, Result, Failure };
  [[nodiscard]] Kind kind_of(std::size_t slot) const { return kinds_[slot]; }
  /// The line of a slot that has one.
  [[nodiscard]] Result<std::string> line_of(std::size_t slot) const;
  /// Fits in runs before whose process died.
  [[nodiscard]] unsigned tries_of(std::size_t slot) const { return tries_[slot]; }

  ResultLog(LineFile results, LineFile failures, LineFile journal, FoundResults found);

 private:
  std::optional<Error> note(const std::string& line);

  LineFile results_;
  LineFile failures_;
  LineFile journal_;
  std::vector<std::uint64_t> offsets_;  ///< of each slot's line
  std::vector<Kind> kinds_;
  std::vector<unsigned char> tries_;
};

/// The line of names of failures.csv, without its end.
std::string failure_names();

/// Whether results.jsonl holds a whole line.
bool has_results(const std::filesystem::path& folder);

}  // namespace slipfit::batch
