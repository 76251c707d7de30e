#include "batch/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>
#include <vector>

#include "slipfit/report/text.hpp"

namespace slipfit::batch {
namespace {

constexpr std::size_t kBuffer = std::size_t{1} << 18;
constexpr mode_t kMode = 0666;
constexpr std::string_view kNew = ".new";
constexpr std::size_t kRandomLength = 6;  // of the X of mkostemps

/// 0, or the errno of the write that failed.
int write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno != EINTR) return errno;
    if (written > 0) text.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

/// What the user's umask takes away from a new file's mode; it can only be asked for by setting it.
mode_t file_mask() {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return mask;
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

std::optional<Error> sync_folder(const std::filesystem::path& folder) {
  const std::filesystem::path place = folder.empty() ? "." : folder;
  const FileHandle handle(::open(place.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!handle) return std::nullopt;                                        // a folder that may be written and not read
  if (::fsync(handle.get()) == 0 || errno == EINVAL) return std::nullopt;  // some file systems have no such thing
  return cannot_write(folder, errno);
}

void remove_leftovers(const std::filesystem::path& folder, const std::function<bool(std::string_view name)>& is_ours) {
  std::error_code error;
  std::vector<std::filesystem::path> leftovers;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    const std::size_t tail = 1 + kRandomLength + kNew.size();
    if (name.size() <= 1 + tail || name.front() != '.' || !name.ends_with(kNew)) continue;
    if (is_ours(std::string_view(name).substr(1, name.size() - 1 - tail))) leftovers.push_back(entry.path());
  }
  for (const std::filesystem::path& leftover : leftovers) std::filesystem::remove(leftover, error);
}

Result<LineFile> LineFile::open(const std::filesystem::path& file, std::uint64_t kept) {
  FileHandle handle(::open(file.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW, kMode));
  if (!handle) return cannot_write(file, errno);
  struct stat status {};
  if (::fstat(handle.get(), &status) != 0) return cannot_write(file, errno);
  const bool has_more = S_ISREG(status.st_mode) && static_cast<std::uint64_t>(status.st_size) > kept;
  if (has_more && ::ftruncate(handle.get(), static_cast<off_t>(kept)) != 0) return cannot_write(file, errno);
  if (auto error = sync_folder(file.parent_path())) return *error;
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
  const std::string pattern =
      "." + file.filename().string() + "." + std::string(kRandomLength, 'X') + std::string(kNew);
  std::string temporary = (file.parent_path() / pattern).string();
  FileHandle handle(::mkostemps(temporary.data(), static_cast<int>(kNew.size()), O_CLOEXEC));
  if (!handle) return cannot_write(file, errno);
  Replacement replacement(file, temporary, std::move(handle));
  if (::fchmod(replacement.handle_.get(), kMode & ~file_mask()) != 0) return cannot_write(file, errno);
  return replacement;
}

Replacement::~Replacement() {
  if (handle_) (void)::unlink(temporary_.c_str());
}

std::optional<Error> Replacement::append(std::string_view text) {
  digester_.add(text);
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
  handle_ = {};
  return sync_folder(file_.parent_path());
}

std::optional<Error> replace_file(const std::filesystem::path& file, std::string_view content) {
  auto replacement = Replacement::open(file);
  if (!replacement) return replacement.error();
  Replacement text = std::move(replacement).value();
  if (auto error = text.append(content)) return error;
  return text.finish();
}

}  // namespace slipfit::batch
