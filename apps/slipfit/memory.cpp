#include "memory.hpp"

#include <malloc.h>
#include <sys/mman.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <new>
#include <system_error>

namespace {

/// Asks for large pages where the heap will grow by `bytes`. They are reserved and given back to the heap unused, so
/// that no memory is taken before it is needed; what lies before the first whole page stays reserved, so that all that
/// follows comes from such pages. Without effect where the system has none.
[[maybe_unused]] void ask_for_large_pages(std::size_t bytes) {
#ifdef MADV_HUGEPAGE
  constexpr std::size_t kLargePage = std::size_t{1} << 21U;  // of x86-64; others' are multiples or refused
  static std::unique_ptr<char[]> before;
  std::unique_ptr<char[]> reserved(new (std::nothrow) char[bytes]);
  void* begin = reserved.get();
  if (begin == nullptr || std::align(kLargePage, kLargePage, begin, bytes) == nullptr) return;
  (void)::madvise(begin, bytes, MADV_HUGEPAGE);
  const std::ptrdiff_t unused = static_cast<char*>(begin) - reserved.get();
  reserved.reset();
  before.reset(new (std::nothrow) char[static_cast<std::size_t>(unused)]);
#endif
}

}  // namespace

void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int kLargest = 1 << 25;  // an array of this size is returned as a whole, glibc takes no larger value
  mallopt(M_MMAP_THRESHOLD, kLargest);
  mallopt(M_TRIM_THRESHOLD, 2 * kLargest);
#endif
}

void prepare_memory([[maybe_unused]] const std::string& file) {
#ifdef __GLIBC__
  constexpr std::uintmax_t kLong = std::uintmax_t{1} << 30U;
  constexpr std::size_t kLeast = std::size_t{1} << 25U;
  constexpr std::size_t kMostLarge = std::size_t{1} << 28U;  // beyond, a system that has none at hand makes them first
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (!(size < kLong)) return;  // the largest number where it has no size
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, -1);
  mallopt(M_ARENA_MAX, 1);  // else FFTW's planner ends the program where memory is short (tests/limits)
  ask_for_large_pages(std::min(kMostLarge, kLeast + 3 * static_cast<std::size_t>(size)));
#endif
}
