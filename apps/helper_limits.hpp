#pragma once

#include <sys/resource.h>

/// For a program beside slipfit that reads a file by large libraries: a file that makes them run on or take all memory
/// ends that program, with no core file.
inline void limit_resources(rlim_t most_memory, rlim_t most_seconds) {
  const rlimit memory{most_memory, most_memory};
  const rlimit time{most_seconds, most_seconds};
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_AS, &memory);
  setrlimit(RLIMIT_CPU, &time);
  setrlimit(RLIMIT_CORE, &no_core);
}
