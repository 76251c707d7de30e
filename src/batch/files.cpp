#include "batch/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "core/platform.hpp"
#include "slipfit/core/printable.hpp"

namespace slipfit::batch {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBuffer = std::size_t{1} << 18;
constexpr mode_t kMode = 0666;

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : ".";
}

/// Returns the name under which a file is written before it replaces another one.
fs::path unfinished(const fs::path& file) {
  return file.parent_path() / fmt::format(".{}.new", file.filename().string());
}

/// Opens a new file and removes one of this name, which a killed process may have left. The new file gets the
/// permissions of the file `mode_of` where that exists, otherwise the usual ones. Returns -1 with errno on failure.
int open_new(const fs::path& file, const fs::path& mode_of) {
  struct stat status {};
  const bool exists = ::lstat(mode_of.c_str(), &status) == 0 && S_ISREG(status.st_mode);
  (void)::unlink(file.c_str());
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, exists ? 0600 : kMode);
  if (descriptor >= 0 && exists) (void)::fchmod(descriptor, status.st_mode & 0777U);  // some file systems have no modes
  return descriptor;
}

}  // namespace

ThrownError file_error(std::string code, const fs::path& file, std::string_view message) {
  return ThrownError({std::move(code), fmt::format("{}: {}", printable(file.string()), message)});
}

ThrownError cannot_write(const fs::path& file, int error_number) {
  return file_error(
      "cannot_write", file,
      fmt::format("cannot be written ({}); correct that, then continue with --resume", std::strerror(error_number)));
}

CheckedFile::CheckedFile(fs::path file, int descriptor) : name(std::move(file)), handle(descriptor) {
  check(descriptor >= 0);
}

bool CheckedFile::check(bool succeeded) {
  if (!succeeded && !error) error = cannot_write(name, errno).error();
  return !error;
}

void CheckedFile::write(std::string_view text) {
  while (!error && !text.empty()) {
    const ssize_t written = ::write(handle.get(), text.data(), text.size());
    check(written >= 0 || errno == EINTR);
    if (written > 0) text.remove_prefix(static_cast<std::size_t>(written));
  }
}

void CheckedFile::sync() {
  if (!error) check(platform::sync_data(handle.get()));
}

void CheckedFile::sync_folder() {
  const FileHandle folder(::open(folder_of(name).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!folder) return;                                   // a folder that may be written and not read
  check(::fsync(folder.get()) == 0 || errno == EINVAL);  // some file systems cannot sync folders
}

void CheckedFile::throw_error() const {
  if (error) throw ThrownError(*error);
}

LineFile::LineFile(const fs::path& file)
    : file_(file, ::open(file.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW, kMode)) {}

LineFile::LineFile(const fs::path& file, std::uint64_t kept) : LineFile(file) {
  struct stat status {};
  if (!file_.check(::fstat(file_.handle.get(), &status) == 0)) return;
  const bool has_more = S_ISREG(status.st_mode) && static_cast<std::uint64_t>(status.st_size) > kept;
  if (has_more) file_.check(::ftruncate(file_.handle.get(), static_cast<off_t>(kept)) == 0);
  file_.sync_folder();
}

std::uint64_t LineFile::append(std::string_view line) {
  file_.write(fmt::format("{}\n", line));
  const off_t end = ::lseek(file_.handle.get(), 0, SEEK_CUR);  // of what this descriptor wrote, whoever wrote since
  if (!file_.check(end >= 0)) return 0;
  return static_cast<std::uint64_t>(end) - line.size() - 1;
}

Result<std::string> LineFile::line_at(std::uint64_t place) const {
  std::string line;
  std::array<char, 16384> chunk{};
  for (;;) {
    const ssize_t count =
        ::pread(file_.handle.get(), chunk.data(), chunk.size(), static_cast<off_t>(place + line.size()));
    if (count <= 0) return file_error("not_readable", file_.name, "a line that was written is missing").error();
    const std::string_view text(chunk.data(), static_cast<std::size_t>(count));
    const std::size_t end = text.find('\n');
    line += text.substr(0, end);
    if (end != std::string_view::npos) return line;
  }
}

void remove_unfinished(const fs::path& file) {
  (void)::unlink(unfinished(file).c_str());
}

Replacement::Replacement(const fs::path& file, const fs::path& mode_of)
    : temporary_(unfinished(file)), file_(file, open_new(temporary_, mode_of)) {}

Replacement::~Replacement() {
  if (file_.handle) (void)::unlink(temporary_.c_str());
}

void Replacement::append(std::string_view text) {
  digester_.add(text);
  buffer_ += text;
  if (buffer_.size() < kBuffer) return;
  file_.write(buffer_);
  buffer_.clear();
}

void Replacement::finish() {
  file_.write(buffer_);
  file_.sync();
  throw_error();
  file_.check(::rename(temporary_.c_str(), file_.name.c_str()) == 0);
  throw_error();
  file_.handle = FileHandle();
  file_.sync_folder();
  throw_error();
}

void replace_file(const fs::path& file, std::string_view content) {
  Replacement replacement(file);
  replacement.append(content);
  replacement.finish();
}

}  // namespace slipfit::batch
