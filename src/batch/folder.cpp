#include "batch/folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <system_error>

#include "batch/result_log.hpp"
#include "slipfit/core/printable.hpp"

namespace slipfit::batch {
namespace {

namespace fs = std::filesystem;

/// The lock file begins with these words: a file of that name without them was written by another program.
constexpr std::string_view kMark = "slipfit batch, ";

std::string text_of(int descriptor) {
  std::array<char, 256> text{};
  const ssize_t count = ::pread(descriptor, text.data(), text.size(), 0);
  return {text.data(), static_cast<std::size_t>(std::max<ssize_t>(0, count))};
}

/// A full disk may refuse the name: the lock holds without it.
void write_owner(int descriptor) {
  std::array<char, 128> host{};
  (void)::gethostname(host.data(), host.size() - 1);
  const std::string owner = fmt::format("{}process {} on {}", kMark, ::getpid(), host.data());
  [[maybe_unused]] const bool is_named =
      ::ftruncate(descriptor, 0) == 0 && ::pwrite(descriptor, owner.data(), owner.size(), 0) > 0;
}

/// A lock of the process, not of the descriptor: children do not share it, and only who may write the file can hold it.
struct flock whole_file() {
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  return lock;
}

ThrownError in_use(const fs::path& file, int descriptor) {
  struct flock lock = whole_file();
  const bool knows_process = ::fcntl(descriptor, F_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
  struct stat status {};
  (void)::fstat(descriptor, &status);
  return file_error(
      "folder_in_use", file,
      fmt::format("in use by process {} ('{}', file of user {}); wait for it, or choose another folder; if that "
                  "process is not slipfit, remove the file",
                  knows_process ? std::to_string(lock.l_pid) : "?", printable(text_of(descriptor)), status.st_uid));
}

ThrownError not_opened(const fs::path& file, int reason) {
  struct stat status {};
  if (reason != EACCES || ::lstat(file.c_str(), &status) != 0) return cannot_write(file, reason);
  return file_error("folder_in_use", file,
                    fmt::format("user {} started a batch in this folder, and the file cannot be opened; if that batch "
                                "has ended, remove the file",
                                status.st_uid));
}

/// The process that held the lock before may have removed the file that has just been locked.
bool is_still(const fs::path& file, int descriptor) {
  struct stat ours {};
  struct stat there {};
  return ::fstat(descriptor, &ours) == 0 && ::lstat(file.c_str(), &there) == 0 && ours.st_ino == there.st_ino &&
         ours.st_dev == there.st_dev;
}

}  // namespace

FolderLock FolderLock::take(const fs::path& folder) {
  std::error_code error;
  fs::create_directory(folder, error);
  if (error) {
    throw file_error("cannot_write", folder,
                     fmt::format("the folder cannot be written ({}); choose another one with --out", error.message()));
  }
  const fs::path file = folder / kLock;
  for (;;) {
    FileHandle handle(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600));
    if (!handle) throw not_opened(file, errno);
    struct flock lock = whole_file();
    if (::fcntl(handle.get(), F_SETLK, &lock) != 0) {
      throw errno == EACCES || errno == EAGAIN ? in_use(file, handle.get()) : cannot_write(file, errno);
    }
    if (!is_still(file, handle.get())) continue;
    const std::string before = text_of(handle.get());
    if (!before.empty() && !before.starts_with(kMark)) {
      throw file_error("folder_of_another_batch", file, "was not written by slipfit batch; choose another folder");
    }
    write_owner(handle.get());
    return {file, std::move(handle)};
  }
}

FolderLock::~FolderLock() {
  if (handle_) (void)::unlink(file_.c_str());
}

bool has_results(const fs::path& folder, const RunRecord& record) {
  if (!record.finished) return journal_has_results(folder);
  std::ifstream stream(folder / kResults, std::ios::binary);
  std::string line;
  return std::getline(stream, line) && !stream.eof();
}

std::optional<RunRecord> check_folder(const fs::path& folder, const RunRecord& now) {
  std::error_code ignored;
  for (const std::string_view name : kFolderFiles) {
    if (!fs::is_symlink(folder / name, ignored)) continue;
    throw file_error("cannot_write", folder / name,
                     "is a symbolic link, which is not followed; remove it, or choose another folder");
  }
  std::optional<RunRecord> before = read_record(folder);
  for (const std::string_view name : kFolderFiles) {
    if (before || !fs::exists(folder / name, ignored)) continue;
    throw file_error("folder_of_another_batch", folder,
                     fmt::format("contains '{}' without the run.json of its batch; choose another folder", name));
  }
  remove_leftovers(folder,
                   [](std::string_view name) { return std::ranges::find(kFolderFiles, name) != kFolderFiles.end(); });
  const auto differs = before && has_results(folder, *before) ? difference(*before, now) : std::nullopt;
  if (!differs) return before;
  throw file_error(
      "folder_of_another_batch", folder,
      fmt::format(
          "contains results of another batch: {}; restore that and use --resume, or choose another folder with --out",
          *differs));
}

}  // namespace slipfit::batch
