#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "slipfit/core/digest.hpp"
#include "slipfit/core/result.hpp"

// Files that survive a kill at any byte. Errors are cannot_write, in one line.

namespace slipfit::batch {

/// A POSIX file descriptor that closes itself.
class FileHandle {
 public:
  FileHandle() = default;
  explicit FileHandle(int descriptor) : descriptor_(descriptor) {}
  ~FileHandle();
  FileHandle(FileHandle&& other) noexcept;
  FileHandle& operator=(FileHandle&& other) noexcept;
  FileHandle(const FileHandle&) = delete;
  FileHandle& operator=(const FileHandle&) = delete;

  [[nodiscard]] int get() const { return descriptor_; }
  explicit operator bool() const { return descriptor_ >= 0; }

 private:
  int descriptor_ = -1;
};

Error cannot_write(const std::filesystem::path& file, int error_number);

/// Waits until the disk knows which files are in the folder.
std::optional<Error> sync_folder(const std::filesystem::path& folder);

/// Removes what a killed process left of files that were being replaced, those that `is_ours` by their names.
void remove_leftovers(const std::filesystem::path& folder, const std::function<bool(std::string_view name)>& is_ours);

/// A file of whole lines that grows at its end.
class LineFile {
 public:
  /// Keeps the first `kept` bytes of what is there and cuts off the rest.
  static Result<LineFile> open(const std::filesystem::path& file, std::uint64_t kept);

  /// The line must hold no line end; one is added. Returns the place where it begins.
  Result<std::uint64_t> append(std::string_view line);
  /// Waits until the disk has everything that was appended before.
  std::optional<Error> sync();
  /// The line that begins at `place`, without its end. Errors: not_readable.
  [[nodiscard]] Result<std::string> line_at(std::uint64_t place) const;

 private:
  LineFile(std::filesystem::path file, FileHandle handle, std::uint64_t size)
      : file_(std::move(file)), handle_(std::move(handle)), size_(size) {}

  std::filesystem::path file_;
  FileHandle handle_;
  std::uint64_t size_;
};

/// A new file beside `file` that takes its place when all is written: readers see the old content or the new. Unless
/// that comes so far, it is removed.
class Replacement {
 public:
  static Result<Replacement> open(const std::filesystem::path& file);
  ~Replacement();
  Replacement(Replacement&& other) noexcept = default;
  Replacement& operator=(Replacement&&) = delete;
  Replacement(const Replacement&) = delete;
  Replacement& operator=(const Replacement&) = delete;

  std::optional<Error> append(std::string_view text);
  /// Writes what is left, waits for the disk and renames.
  std::optional<Error> finish();
  /// Of all that was appended.
  [[nodiscard]] Digest digest() const { return digester_.digest(); }

 private:
  Replacement(std::filesystem::path file, std::filesystem::path temporary, FileHandle handle)
      : file_(std::move(file)), temporary_(std::move(temporary)), handle_(std::move(handle)) {}
  std::optional<Error> flush();

  std::filesystem::path file_;
  std::filesystem::path temporary_;
  FileHandle handle_;
  std::string buffer_;
  Digester digester_;
};

std::optional<Error> replace_file(const std::filesystem::path& file, std::string_view content);

}  // namespace slipfit::batch
