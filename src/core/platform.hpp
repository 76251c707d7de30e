#pragma once

// What differs between operating systems, in this one file: Linux with glibc, and systems with POSIX alone, such as
// macOS. Everything else is C++20 and POSIX.

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>
#ifdef __linux__
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#endif
#ifdef __GLIBC__
#include <malloc.h>
#endif
#ifdef __APPLE__
#include <mach-o/dyld.h>
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <thread>

namespace slipfit::platform {

/// The file that a program has as descriptor 3.
#ifdef __linux__
inline constexpr const char* kFileOfDescriptor3 = "/proc/self/fd/3";
#else
inline constexpr const char* kFileOfDescriptor3 = "/dev/fd/3";
#endif

/// A flag for `send` with which an end that nobody reads is an error and not a signal. Systems without the flag have a
/// property of the socket, which connected_sockets sets.
#ifdef MSG_NOSIGNAL
inline constexpr int kSendFlags = MSG_NOSIGNAL;
#else
inline constexpr int kSendFlags = 0;
#endif

/// A new program does not inherit the descriptor.
inline void close_on_exec(int descriptor) {
  (void)::fcntl(descriptor, F_SETFD, FD_CLOEXEC);
}

/// Descriptor of a file without a name, in memory where the system has that; negative where none can be made.
inline int open_nameless_file() {
#ifdef __linux__
  return ::memfd_create("slipfit", MFD_CLOEXEC);
#else
  std::error_code error;
  std::string name = (std::filesystem::temp_directory_path(error) / "slipfit-XXXXXX").string();
  const int descriptor = error ? -1 : ::mkstemp(name.data());
  if (descriptor < 0) return descriptor;
  (void)::unlink(name.c_str());
  close_on_exec(descriptor);
  return descriptor;
#endif
}

/// The ends of a pipe, to be read and to be written; negative where none can be made.
inline std::array<int, 2> open_pipe() {
  std::array<int, 2> ends{-1, -1};
#ifdef __linux__
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return {-1, -1};
#else
  if (::pipe(ends.data()) != 0) return {-1, -1};
  for (const int end : ends) close_on_exec(end);
#endif
  return ends;
}

/// Returns both ends of a connection; negative numbers if none can be created.
inline std::array<int, 2> connected_sockets() {
  std::array<int, 2> ends{-1, -1};
#ifdef SOCK_CLOEXEC
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) return {-1, -1};
#else
  if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) != 0) return {-1, -1};
  for (const int end : ends) close_on_exec(end);
#endif
#ifdef SO_NOSIGPIPE
  const int on = 1;
  for (const int end : ends) (void)::setsockopt(end, SOL_SOCKET, SO_NOSIGPIPE, &on, sizeof(on));
#endif
  return ends;
}

/// Flushes written data to the disk; returns false, with errno, if that fails.
inline bool sync_data(int descriptor) {
#ifdef __APPLE__
  return ::fcntl(descriptor, F_FULLFSYNC) == 0 || ::fsync(descriptor) == 0;
#elif defined(__EMSCRIPTEN__)
  return ::fsync(descriptor) == 0;
#else
  return ::fdatasync(descriptor) == 0;
#endif
}

/// The process is killed when the one that started it ends, where the system can do that.
inline void end_with_parent() {
#ifdef __linux__
  (void)::prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
}

/// The file of the running program; empty where the system does not say.
inline std::filesystem::path program_file() {
#ifdef __APPLE__
  std::string name(4096, '\0');
  auto size = static_cast<std::uint32_t>(name.size());
  return _NSGetExecutablePath(name.data(), &size) == 0 ? std::filesystem::path(name.c_str()) : std::filesystem::path();
#else
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error);
#endif
}

/// Processors that a control group allows; empty without a limit. Version 2 has the file cpu.max ("QUOTA PERIOD" or
/// "max PERIOD"), version 1 two files, whose quota is -1 without a limit.
inline std::optional<std::size_t> processors_in(const std::filesystem::path& group) {
  double quota_us = 0.0;
  double period_us = 0.0;
  std::ifstream both(group / "cpu.max");
  std::ifstream quota(group / "cpu.cfs_quota_us");
  std::ifstream period(group / "cpu.cfs_period_us");
  const bool is_read = (both >> quota_us >> period_us) || (quota >> quota_us && period >> period_us);
  if (!is_read || !(quota_us > 0.0) || !(period_us > 0.0)) return std::nullopt;
  return static_cast<std::size_t>(std::max(1.0, std::ceil(quota_us / period_us)));
}

/// A line of /proc/self/cgroup, "ID:CONTROLLERS:/GROUP".
struct ControlGroup {
  std::filesystem::path mount;  ///< below the folder of all control groups; empty in version 2
  std::filesystem::path group;  ///< below `mount`
};

/// Empty where the line is of a hierarchy of version 1 that does not limit processors. A container may see the paths
/// of its host, which it does not have; the walk to the root of the hierarchy then ends at the container's own limit.
inline std::optional<ControlGroup> control_group_in(const std::string& line) {
  const std::size_t first = line.find(':');
  const std::size_t second = first == std::string::npos ? first : line.find(':', first + 1);
  if (second == std::string::npos || !line.substr(second).starts_with(":/")) return std::nullopt;
  const std::string controllers = line.substr(first + 1, second - first - 1);
  const bool is_version_2 = controllers.empty();
  if (!is_version_2 && (',' + controllers + ',').find(",cpu,") == std::string::npos) return std::nullopt;
  return ControlGroup{controllers, line.substr(second + 2)};
}

/// The least that a process's control groups and those above them allow (containers, Slurm). `groups`:
/// /proc/self/cgroup; `root`: the folder of all control groups.
inline std::optional<std::size_t> processors_of_groups(const std::filesystem::path& groups,
                                                       const std::filesystem::path& root) {
  std::ifstream file(groups);
  std::optional<std::size_t> least;
  for (std::string line; std::getline(file, line);) {
    const std::optional<ControlGroup> found = control_group_in(line);
    if (!found) continue;
    std::error_code error;
    const bool is_there = found->mount.empty() || std::filesystem::exists(root / found->mount, error);
    const std::filesystem::path mount = is_there ? root / found->mount : root / "cpu";
    for (std::filesystem::path group = found->group;; group = group.parent_path()) {
      const std::optional<std::size_t> here = processors_in(mount / group);
      if (here) least = std::min(*here, least.value_or(*here));
      if (group.empty()) break;
    }
  }
  return least;
}

/// Processors of the machine that the process may use: what a batch system, a container or taskset leaves of them.
inline std::size_t processors() {
  std::size_t count = std::max(1U, std::thread::hardware_concurrency());
#ifdef __linux__
  cpu_set_t set;
  if (::sched_getaffinity(0, sizeof(set), &set) == 0) count = static_cast<std::size_t>(CPU_COUNT(&set));
  count = std::min(count, processors_of_groups("/proc/self/cgroup", "/sys/fs/cgroup").value_or(count));
#endif
  return count;
}

/// Freed arrays up to this size are kept for the next ones.
inline void keep_freed_memory([[maybe_unused]] int largest) {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, largest);
  mallopt(M_TRIM_THRESHOLD, 2 * largest);
#endif
}

/// Makes all memory come from one heap, which never shrinks. Returns false if the system has no such setting.
inline bool use_one_heap() {
#ifdef __GLIBC__
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, -1);
  mallopt(M_ARENA_MAX, 1);  // else FFTW's planner ends the program where memory is short (tests/limits)
  return true;
#else
  return false;
#endif
}

/// Size of a large page of memory (of x86-64; others' are multiples or refused); empty where there are none.
inline std::optional<std::size_t> large_page() {
#ifdef MADV_HUGEPAGE
  return std::size_t{1} << 21U;
#else
  return std::nullopt;
#endif
}

/// Requests large pages in a range that starts with one.
inline void ask_for_large_pages([[maybe_unused]] void* begin, [[maybe_unused]] std::size_t bytes) {
#ifdef MADV_HUGEPAGE
  (void)::madvise(begin, bytes, MADV_HUGEPAGE);
#endif
}

}  // namespace slipfit::platform
