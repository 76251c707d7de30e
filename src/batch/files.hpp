#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/file_handle.hpp"
#include "core/thrown_error.hpp"
#include "slipfit/core/digest.hpp"
#include "slipfit/core/result.hpp"

// Files that survive a kill at any byte. A file keeps its first error (cannot_write, one line) and writes nothing more.
// In this folder errors are thrown: run_batch and merge_batches return them.

namespace slipfit::batch {

/// Files that a batch writes into its folder, in addition to the lock.
constexpr const char* kResults = "results.jsonl";
constexpr const char* kSummary = "summary.csv";
constexpr const char* kFailures = "failures.csv";
constexpr const char* kRunFile = "run.json";
constexpr const char* kJournal = "journal";  // while the batch is not finished, and instead of the final files
constexpr std::array<std::string_view, 5> kFolderFiles{kResults, kSummary, kFailures, kRunFile, kJournal};
constexpr const char* kLock = "lock";

/// An error about a file, on one line.
ThrownError file_error(std::string code, const std::filesystem::path& file, std::string_view message);
ThrownError cannot_write(const std::filesystem::path& file, int error_number);

/// An open file that keeps the first error of what is done with it.
struct CheckedFile {
  CheckedFile(std::filesystem::path file, int descriptor);

  /// Takes errno for the reason of a call that failed. Returns whether all calls have succeeded so far.
  bool check(bool succeeded);
  void write(std::string_view text);
  /// Waits until the disk has what was written before.
  void sync();
  /// Waits until the disk knows which files are in the folder.
  void sync_folder();
  void throw_error() const;

  std::filesystem::path name;
  FileHandle handle;
  std::optional<Error> error;
};

/// A file of whole lines that grows at its end, also by other processes that have it open for themselves.
class LineFile {
 public:
  /// Keeps the first `kept` bytes of what is there and cuts off the rest.
  LineFile(const std::filesystem::path& file, std::uint64_t kept);
  /// Opens the file once more, as another process should: what it appends does not move the place of this one.
  [[nodiscard]] LineFile opened_again() const { return LineFile(file_.name); }

  /// The line must hold no line end; one is added. Returns the place where it begins.
  std::uint64_t append(std::string_view line);
  /// Waits until the disk has everything that was appended before.
  void sync() { file_.sync(); }
  void throw_error() const { file_.throw_error(); }
  /// The text from `place` to the end of its line. Errors: not_readable.
  [[nodiscard]] Result<std::string> line_at(std::uint64_t place) const;

 private:
  explicit LineFile(const std::filesystem::path& file);

  CheckedFile file_;
};

/// A new file next to `file` that replaces it when everything is written: readers see the old content or the new.
/// Unless `finish` succeeds, it is removed; one process at a time may replace a file.
class Replacement {
 public:
  explicit Replacement(const std::filesystem::path& file) : Replacement(file, file) {}
  /// The new file has the mode of the regular file `mode_of`; where there is none, that which the umask leaves.
  Replacement(const std::filesystem::path& file, const std::filesystem::path& mode_of);
  ~Replacement();
  Replacement(const Replacement&) = delete;
  Replacement& operator=(const Replacement&) = delete;
  Replacement(Replacement&&) = delete;
  Replacement& operator=(Replacement&&) = delete;

  void append(std::string_view text);
  /// Writes what is left, waits for the disk and renames.
  void finish();
  void throw_error() const { file_.throw_error(); }
  /// Returns the digest of everything that was appended.
  [[nodiscard]] Digest digest() const { return digester_.digest(); }

 private:
  std::filesystem::path temporary_;
  CheckedFile file_;
  std::string buffer_;
  Digester digester_;
};

void replace_file(const std::filesystem::path& file, std::string_view content);

/// Removes what a process left that was killed while it replaced a file, if it left anything.
void remove_unfinished(const std::filesystem::path& file);

}  // namespace slipfit::batch
