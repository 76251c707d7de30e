#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "batch/files.hpp"
#include "batch/run_file.hpp"
#include "batch/work_list.hpp"
#include "slipfit/core/result.hpp"

// The file `journal` holds all that an unfinished batch has done, one event a line in the order of time:
//   DIGEST begin SLOT          a fit begins; where its process dies nothing follows
//   DIGEST fit SLOT DOCUMENT   its result
//   DIGEST error SLOT FAILURE  its line of failures.csv
//   DIGEST end SLOT            it was stopped, or brought nothing new
// The digest is that of the rest of the line: a line that is torn or was altered is left out. A finished batch has the
// final files in its place (folder.hpp).

namespace slipfit::batch {

class ResultLog {
 public:
  /// Reads the journal of a folder, or begins one. Failures of an earlier run are tried again: they are left out.
  ResultLog(const std::filesystem::path& folder, std::size_t slots);

  /// A fit begins. Called in the process that fits. Errors: cannot_write.
  void begin(std::size_t slot) const;
  void add_result(std::size_t slot, std::string_view document);
  void add_failure(std::size_t slot, const std::string& id, const Error& failure);
  /// The fit was stopped, or brought nothing new.
  void add_end(std::size_t slot);
  /// Waits until the disk has what was added before.
  void sync() { file_.sync(); }
  /// The first error of what was done: cannot_write. Nothing is written after it.
  void throw_error() const { file_.throw_error(); }

  enum class Kind : unsigned char { Nothing, Result, Failure };
  [[nodiscard]] Kind kind_of(std::size_t slot) const { return slots_[slot].kind; }
  [[nodiscard]] bool has_result(std::size_t slot) const { return kind_of(slot) == Kind::Result; }
  /// The document or the line of failures.csv of a slot that has one.
  [[nodiscard]] Result<std::string> line_of(std::size_t slot) const { return file_.line_at(slots_[slot].place); }
  /// Fits in runs before whose process died.
  [[nodiscard]] unsigned tries_of(std::size_t slot) const { return slots_[slot].tries; }
  /// The number of whole lines that were found and are not as they were written.
  [[nodiscard]] std::size_t damaged() const { return damaged_; }

 private:
  struct Slot {
    std::uint64_t place = 0;  ///< of the document or failure in the file
    Kind kind = Kind::Nothing;
    unsigned char tries = 0;
  };

  void take(std::string_view line, std::uint64_t place);
  void add(Kind kind, std::size_t slot, std::string_view word, std::string_view content);

  std::vector<Slot> slots_;
  std::size_t damaged_ = 0;
  LineFile file_;
};

/// Returns true if the journal of a folder holds a result.
bool journal_has_results(const std::filesystem::path& folder);

/// Writes the journal that a resumed batch begins with: the results of the finished batch `before`, or none. Returns
/// how many results are not as they were written and were left out.
std::size_t begin_journal(const std::filesystem::path& folder, const RunRecord* before, const WorkList& list);

void remove_journal(const std::filesystem::path& folder);

}  // namespace slipfit::batch
