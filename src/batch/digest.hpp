#pragma once

#include <cstdint>
#include <string_view>

namespace slipfit::batch {

constexpr std::uint64_t kEmptyDigest = 14695981039346656037ULL;

/// FNV-1a, 64 bit: the same on every machine and in every version, which std::hash does not promise.
constexpr std::uint64_t digest(std::string_view bytes, std::uint64_t so_far = kEmptyDigest) {
  for (const char c : bytes) so_far = (so_far ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return so_far;
}

}  // namespace slipfit::batch
