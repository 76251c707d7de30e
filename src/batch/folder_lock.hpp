#pragma once

#include <filesystem>

#include "batch/files.hpp"
#include "slipfit/core/result.hpp"

namespace slipfit::batch {

/// Keeps other processes out of a folder as long as it lives. The kernel gives it up with the process, so that the
/// lock of a dead one is void; the file `lock` only says whose it is.
class FolderLock {
 public:
  /// Makes the folder where it is missing. Errors: folder_in_use, cannot_write, folder_of_another_batch where the file
  /// `lock` is somebody else's.
  static Result<FolderLock> take(const std::filesystem::path& folder);
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

}  // namespace slipfit::batch
