#include "slipfit/io/file_hash.hpp"

#include <fmt/format.h>
#include <nettle/sha2.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <vector>

namespace slipfit {
namespace {

constexpr std::size_t kBlock = 1U << 18U;

using Digest = std::array<std::uint8_t, SHA256_DIGEST_SIZE>;

std::string hexadecimal(const Digest& digest) {
  std::string text;
  for (const std::uint8_t byte : digest) text += fmt::format("{:02x}", byte);
  return text;
}

}  // namespace

std::optional<std::string> sha256_of_file(const std::string& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return std::nullopt;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return std::nullopt;
  sha256_ctx context{};
  sha256_init(&context);
  std::vector<std::uint8_t> block(kBlock);
  while (stream) {
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): Nettle's bytes are unsigned
    stream.read(reinterpret_cast<char*>(block.data()), static_cast<std::streamsize>(block.size()));
    sha256_update(&context, static_cast<std::size_t>(stream.gcount()), block.data());
  }
  if (!stream.eof()) return std::nullopt;
  Digest digest{};
  sha256_digest(&context, digest.size(), digest.data());
  return hexadecimal(digest);
}

}  // namespace slipfit
