#pragma once

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "core/platform.hpp"

// What a program that reads a file by large libraries for slipfit does to itself, because the file may be hostile.

/// A file that makes the program run on or take all memory ends it, with no core file.
inline void limit_resources(rlim_t most_memory, rlim_t most_seconds) {
  const rlimit memory{most_memory, most_memory};
  const rlimit time{most_seconds, most_seconds};
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_AS, &memory);
  setrlimit(RLIMIT_CPU, &time);
  setrlimit(RLIMIT_CORE, &no_core);
}

/// The program is killed when slipfit ends. If slipfit has ended before the call, nobody reads standard output.
inline void end_with_slipfit() {
  slipfit::platform::end_with_parent();
  pollfd output{STDOUT_FILENO, 0, 0};
  if (::poll(&output, 1, 0) == 1 && (output.revents & POLLERR) != 0) ::_exit(1);
}

/// Prevents the process from opening any file, pipe or socket; the limit cannot be raised again. A file can then not
/// make the libraries read another one, nor can HDF5 load filters from files.
inline void forbid_opening_files() {
  const rlimit none{0, 0};
  setrlimit(RLIMIT_NOFILE, &none);
}

/// The whole file, which stays in memory to the end of the program; after that no other one can be opened. What is not
/// looked at is not read. Throws std::exception.
inline std::string_view map_only_file(const char* name) {
  const std::size_t size = std::filesystem::file_size(name);
  const int file = ::open(name, O_RDONLY);
  void* const bytes = size > 0 && file >= 0 ? ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file, 0) : MAP_FAILED;
  forbid_opening_files();
  if (bytes != MAP_FAILED) return {static_cast<const char*>(bytes), size};
  if (size == 0) return {};
  throw std::system_error(errno, std::generic_category(), "the file cannot be read");
}

/// Ends the program without the exit handlers of the libraries, which may want to open files. Standard output must have
/// been flushed.
[[noreturn]] inline void end_program(int status) {
  std::_Exit(status);
}
