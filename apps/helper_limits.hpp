#pragma once

#include <poll.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

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

/// From now on no file, pipe or socket can be opened, and the limit cannot be raised again: a file must not make the
/// libraries read another one. Filters that HDF5 loads from files are out of reach, too.
inline void forbid_opening_files() {
  const rlimit none{0, 0};
  setrlimit(RLIMIT_NOFILE, &none);
}

/// The whole file; after that no other one can be opened. Throws std::exception.
inline std::string read_only_file(const char* name) {
  std::ifstream opened(name, std::ios::binary);
  std::string file(std::filesystem::file_size(name), '\0');
  opened.read(file.data(), static_cast<std::streamsize>(file.size()));
  forbid_opening_files();
  return file;
}

/// Ends the program without the exit handlers of the libraries, which may want to open files. Standard output must have
/// been flushed.
[[noreturn]] inline void end_program(int status) {
  std::_Exit(status);
}
