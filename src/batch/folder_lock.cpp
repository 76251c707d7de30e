#include "batch/folder_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <string>
#include <string_view>
#include <system_error>

#include "slipfit/report/text.hpp"

namespace slipfit::batch {
namespace {

namespace fs = std::filesystem;

/// With these words the file begins, so that nobody else's file of the name is taken for a lock.
constexpr std::string_view kMark = "slipfit batch, ";

std::string text_of(int descriptor) {
  std::array<char, 256> text{};
  const ssize_t count = ::pread(descriptor, text.data(), text.size(), 0);
  return {text.data(), static_cast<std::size_t>(std::max<ssize_t>(0, count))};
}

std::string this_process() {
  std::array<char, 128> host{};
  (void)::gethostname(host.data(), host.size() - 1);
  return fmt::format("{}process {} on {}", kMark, ::getpid(), host.data());
}

/// A lock of the process, not of the descriptor: a child has no part in it, and only who may write the file can hold
/// it.
struct flock whole_file() {
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  return lock;
}

Error in_use(const fs::path& file, int descriptor) {
  struct flock lock = whole_file();
  const bool knows_process = ::fcntl(descriptor, F_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
  struct stat status {};
  (void)::fstat(descriptor, &status);
  return {
      "folder_in_use",
      fmt::format("{}: in use by process {} ('{}', file of user {}); wait for it, or choose another folder; if that "
                  "process is no slipfit, remove the file",
                  one_line(file.string()), knows_process ? std::to_string(lock.l_pid) : "?",
                  one_line(text_of(descriptor)), status.st_uid)};
}

Error not_opened(const fs::path& file, int reason) {
  struct stat status {};
  if (reason != EACCES || ::lstat(file.c_str(), &status) != 0) return cannot_write(file, reason);
  return {"folder_in_use", fmt::format("{}: user {} began a batch in this folder, and the file may not be opened; if "
                                       "that batch has ended, remove the file",
                                       one_line(file.string()), status.st_uid)};
}

/// The one who held the lock before may have removed the file that we have just locked.
bool is_still(const fs::path& file, int descriptor) {
  struct stat ours {};
  struct stat there {};
  return ::fstat(descriptor, &ours) == 0 && ::lstat(file.c_str(), &there) == 0 && ours.st_ino == there.st_ino &&
         ours.st_dev == there.st_dev;
}

}  // namespace

Result<FolderLock> FolderLock::take(const fs::path& folder) {
  std::error_code error;
  fs::create_directory(folder, error);
  if (error) {
    return Error{"cannot_write", fmt::format("{}: the folder cannot be written ({}); choose another one with --out",
                                             one_line(folder.string()), error.message())};
  }
  const fs::path file = folder / "lock";
  for (;;) {
    FileHandle handle(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600));
    if (!handle) return not_opened(file, errno);
    struct flock lock = whole_file();
    if (::fcntl(handle.get(), F_SETLK, &lock) != 0) {
      return errno == EACCES || errno == EAGAIN ? in_use(file, handle.get()) : cannot_write(file, errno);
    }
    if (!is_still(file, handle.get())) continue;
    const std::string before = text_of(handle.get());
    if (!before.empty() && !before.starts_with(kMark)) {
      return Error{"folder_of_another_batch",
                   one_line(file.string()) + ": was not written by slipfit batch; choose another folder"};
    }
    const std::string owner = this_process();
    [[maybe_unused]] const bool is_named =  // a full disk may refuse the name: the lock holds without it
        ::ftruncate(handle.get(), 0) == 0 && ::pwrite(handle.get(), owner.data(), owner.size(), 0) > 0;
    return FolderLock(file, std::move(handle));
  }
}

FolderLock::~FolderLock() {
  if (handle_) (void)::unlink(file_.c_str());
}

}  // namespace slipfit::batch
