#include "batch/folder_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>
#include <system_error>

#include "slipfit/report/text.hpp"

namespace slipfit::batch {
namespace {

namespace fs = std::filesystem;

std::string owner_of(int descriptor) {
  std::array<char, 256> text{};
  const ssize_t count = ::pread(descriptor, text.data(), text.size(), 0);
  return count > 0 ? one_line({text.data(), static_cast<std::size_t>(count)}) : "another process";
}

std::string this_process() {
  std::array<char, 128> host{};
  (void)::gethostname(host.data(), host.size() - 1);
  return fmt::format("process {} on {}", ::getpid(), host.data());
}

/// The one who held the lock before may have removed the file that we have just locked.
bool is_still(const fs::path& file, int descriptor) {
  struct stat ours {};
  struct stat there {};
  return ::fstat(descriptor, &ours) == 0 && ::stat(file.c_str(), &there) == 0 && ours.st_ino == there.st_ino &&
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
    FileHandle handle(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
    if (!handle) return cannot_write(file, errno);
    if (::flock(handle.get(), LOCK_EX | LOCK_NB) != 0) {
      if (errno != EWOULDBLOCK) return cannot_write(file, errno);
      return Error{"folder_in_use", fmt::format("{}: {} is working in this folder; wait for it, or choose another one",
                                                one_line(folder.string()), owner_of(handle.get()))};
    }
    if (!is_still(file, handle.get())) continue;
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
