#include "batch/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "slipfit/report/text.hpp"

namespace slipfit::batch {
namespace {

constexpr std::size_t kBuffer = std::size_t{1} << 18;
constexpr int kMode = 0666;

/// 0, or the errno of the write that failed.
int write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno != EINTR) return errno;
    if (written > 0) text.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

}  // namespace

FileHandle::~FileHandle() {
  if (descriptor_ >= 0) ::close(descriptor_);
}
FileHandle::FileHandle(FileHandle&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
FileHandle& FileHandle::operator=(FileHandle&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

Error cannot_write(const std::filesystem::path& file, int error_number) {
  return {"cannot_write", fmt::format("{}: cannot be written ({}); mend that, then go on with --resume",
                                      one_line(file.string()), std::strerror(error_number))};
}

Result<LineFile> LineFile::open(const std::filesystem::path& file, std::uint64_t kept) {
  FileHandle handle(::open(file.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, kMode));
  if (!handle) return cannot_write(file, errno);
  struct stat status {};
  if (::fstat(handle.get(), &status) != 0) return cannot_write(file, errno);
  const bool has_more = S_ISREG(status.st_mode) && static_cast<std::uint64_t>(status.st_size) > kept;
  if (has_more && ::ftruncate(handle.get(), static_cast<off_t>(kept)) != 0) return cannot_write(file, errno);
  return LineFile(file, std::move(handle), kept);
}

Result<std::uint64_t> LineFile::append(std::string_view line) {
  std::string text(line);
  text += '\n';
  if (const int failed = write_all(handle_.get(), text); failed != 0) return cannot_write(file_, failed);
  return std::exchange(size_, size_ + text.size());
}

std::optional<Error> LineFile::sync() {
  if (::fdatasync(handle_.get()) == 0) return std::nullopt;
  return cannot_write(file_, errno);
}

Result<std::string> LineFile::line_at(std::uint64_t place) const {
  std::string line;
  std::array<char, 16384> chunk{};
  for (;;) {
    const ssize_t count = ::pread(handle_.get(), chunk.data(), chunk.size(), static_cast<off_t>(place + line.size()));
    if (count <= 0) return Error{"not_readable", one_line(file_.string()) + ": a line that was written is gone"};
    const std::string_view text(chunk.data(), static_cast<std::size_t>(count));
    const std::size_t end = text.find('\n');
    line += text.substr(0, end);
    if (end != std::string_view::npos) return line;
  }
}

Result<Replacement> Replacement::open(const std::filesystem::path& file) {
  // One name for all processes: the lock of the folder keeps them apart, and what a killed one left is overwritten.
  const std::filesystem::path temporary = file.parent_path() / ("." + file.filename().string() + ".new");
  FileHandle handle(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kMode));
  if (!handle) return cannot_write(file, errno);
  return Replacement(file, temporary, std::move(handle));
}

std::optional<Error> Replacement::append(std::string_view text) {
  buffer_ += text;
  return buffer_.size() < kBuffer ? std::nullopt : flush();
}

std::optional<Error> Replacement::flush() {
  if (const int failed = write_all(handle_.get(), buffer_); failed != 0) return cannot_write(file_, failed);
  buffer_.clear();
  return std::nullopt;
}

std::optional<Error> Replacement::finish() {
  if (auto error = flush()) return error;
  if (::fdatasync(handle_.get()) != 0) return cannot_write(file_, errno);
  if (::rename(temporary_.c_str(), file_.c_str()) != 0) return cannot_write(file_, errno);
  return std::nullopt;
}

std::optional<Error> replace_file(const std::filesystem::path& file, std::string_view content) {
  auto replacement = Replacement::open(file);
  if (!replacement) return replacement.error();
  Replacement text = std::move(replacement).value();
  if (auto error = text.append(content)) return error;
  return text.finish();
}

}  // namespace slipfit::batch
