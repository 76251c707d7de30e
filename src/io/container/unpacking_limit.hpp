#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "io/container/formats.hpp"

namespace slipfit::reading {

/// Returns true if `unpacked` bytes are out of proportion to the `packed` bytes from which they come: deflate
/// compresses by a factor of 1000 at most, and recordings by about 10.
constexpr bool is_bomb(std::uintmax_t unpacked, std::uintmax_t packed) {
  constexpr std::uintmax_t kSmall = std::uintmax_t{64} << 20U;
  constexpr std::uintmax_t kHighestRatio = 200;
  return unpacked > kSmall && unpacked / kHighestRatio > packed;
}

/// Counts what a file is unpacked to and compares it with the bytes that the file has. The sizes that an archive states
/// do not enter.
class UnpackingLimit {
 public:
  explicit UnpackingLimit(std::string file, std::uintmax_t packed = 0) : file_(std::move(file)), packed_(packed) {}

  void add_packed(std::uintmax_t bytes) { packed_ += bytes; }
  /// Counts decompressed bytes. Error: container_too_large.
  void add_unpacked(std::uintmax_t bytes) {
    unpacked_ += bytes;
    if (is_bomb(unpacked_, packed_)) throw too_large(file_);
  }

 private:
  std::string file_;
  std::uintmax_t packed_;
  std::uintmax_t unpacked_ = 0;
};

}  // namespace slipfit::reading
