#include "slipfit/core/digest.hpp"

// The functions are compiled into this file, so that nothing has to be linked.
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <vector>

namespace slipfit {
namespace {

constexpr std::size_t kBlock = std::size_t{256} * 1024;

Digest digest_from(const XXH128_hash_t& hash) {
  return {hash.high64, hash.low64};
}

}  // namespace

struct Digester::State {
  XXH3_state_t xxh3{};
};

Digester::Digester() : state_(std::make_unique<State>()) {
  XXH3_128bits_reset(&state_->xxh3);
}
Digester::~Digester() = default;
Digester::Digester(Digester&&) noexcept = default;
Digester& Digester::operator=(Digester&&) noexcept = default;

void Digester::add(std::string_view bytes) {
  XXH3_128bits_update(&state_->xxh3, bytes.data(), bytes.size());
  bytes_ += bytes.size();
}

Digest Digester::digest() const {
  return digest_from(XXH3_128bits_digest(&state_->xxh3));
}

std::string Digest::text() const {
  std::array<char, 48> text{};
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): the layer core has no formatting library
  const int length = std::snprintf(text.data(), text.size(), "xxh128:%016llx%016llx",
                                   static_cast<unsigned long long>(high), static_cast<unsigned long long>(low));
  return {text.data(), static_cast<std::size_t>(length)};
}

Digest digest_of(std::string_view bytes) {
  return digest_from(XXH3_128bits(bytes.data(), bytes.size()));
}

std::optional<Digest> digest_of_file(const std::string& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return std::nullopt;
  std::ifstream stream(file, std::ios::binary);
  Digester digester;
  std::vector<char> block(kBlock);
  while (stream) {
    stream.read(block.data(), static_cast<std::streamsize>(block.size()));
    digester.add({block.data(), static_cast<std::size_t>(stream.gcount())});
  }
  if (!stream.eof()) return std::nullopt;
  return digester.digest();
}

}  // namespace slipfit
