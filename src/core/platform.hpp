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

/// Processors that a control group allows, by its file cpu.max ("QUOTA PERIOD" or "max PERIOD"); empty without a limit.
inline std::optional<std::size_t> processors_in(const std::filesystem::path& cpu_max) {
  std::ifstream file(cpu_max);
  double quota_us = 0.0;
  double period_us = 0.0;
  if (!(file >> quota_us >> period_us) || !(quota_us > 0.0) || !(period_us > 0.0)) return std::nullopt;
  return static_cast<std::size_t>(std::max(1.0, std::ceil(quota_us / period_us)));
}

/// The least that a process's control group and those above it allow (containers, Slurm). `groups`: /proc/self/cgroup;
/// `root`: where control groups of version 2 are mounted.
inline std::optional<std::size_t> processors_of_groups(const std::filesystem::path& groups,
                                                       const std::filesystem::path& root) {
  std::ifstream file(groups);
  std::string line;
  while (std::getline(file, line) && !line.starts_with("0::/")) continue;
  if (!line.starts_with("0::/")) return std::nullopt;
  std::optional<std::size_t> least;
  for (std::filesystem::path group = line.substr(4);; group = group.parent_path()) {
    const std::optional<std::size_t> here = processors_in(root / group / "cpu.max");
    if (here) least = std::min(*here, least.value_or(*here));
    if (group.empty()) return least;
  }
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
