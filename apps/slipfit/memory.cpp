#include "memory.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <new>
#include <optional>
#include <system_error>

#include "core/platform.hpp"

namespace {

/// Asks for large pages where the heap will grow by `bytes`. They are reserved and given back to the heap unused, so
/// that no memory is taken before it is needed; what lies before the first whole page stays reserved, so that all that
/// follows comes from such pages. Without effect where the system has none.
void ask_for_large_pages(std::size_t bytes) {
  const std::optional<std::size_t> page = slipfit::platform::large_page();
  if (!page) return;
  static std::unique_ptr<char[]> before;
  std::unique_ptr<char[]> reserved(new (std::nothrow) char[bytes]);
  void* begin = reserved.get();
  if (begin == nullptr || std::align(*page, *page, begin, bytes) == nullptr) return;
  slipfit::platform::ask_for_large_pages(begin, bytes);
  const std::ptrdiff_t unused = static_cast<char*>(begin) - reserved.get();
  reserved.reset();
  before.reset(new (std::nothrow) char[static_cast<std::size_t>(unused)]);
}

}  // namespace

void keep_freed_memory() {
  constexpr int kLargest = 1 << 25;  // an array of this size is returned as a whole, glibc takes no larger value
  slipfit::platform::keep_freed_memory(kLargest);
}

void prepare_memory(const std::string& file) {
  constexpr std::uintmax_t kLong = std::uintmax_t{1} << 30U;
  constexpr std::size_t kLeast = std::size_t{1} << 25U;
  constexpr std::size_t kMostLarge = std::size_t{1} << 28U;  // beyond, a system that has none at hand makes them first
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (!(size < kLong)) return;  // the largest number where it has no size
  if (!slipfit::platform::use_one_heap()) return;
  ask_for_large_pages(std::min(kMostLarge, kLeast + 3 * static_cast<std::size_t>(size)));
}
