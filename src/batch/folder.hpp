#pragma once

#include <filesystem>
#include <optional>

#include "batch/files.hpp"
#include "batch/run_file.hpp"

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

/// The record of the batch that a folder holds, if any; temporary files that killed processes left are removed. Errors:
/// folder_of_another_batch where it holds results of another batch than `now`, or files of a batch's names that no
/// batch wrote; cannot_write where they are symbolic links, which are not followed.
std::optional<RunRecord> check_folder(const std::filesystem::path& folder, const RunRecord& now);

/// Returns true if the folder holds a result of the batch of this record.
bool has_results(const std::filesystem::path& folder, const RunRecord& record);

}  // namespace slipfit::batch
