#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <fstream>
#include <memory>

#include "tables.hpp"

namespace {

[[noreturn]] void refuse_damaged() {
  throw Refusal("damaged_container the .mat file is damaged or cut off; save it again");
}

struct EndInflate {
  void operator()(z_stream* state) const { inflateEnd(state); }
};

/// Unpacks to nowhere: the checksum at the end must be right.
std::uint64_t unpacked_size(std::ifstream& file, std::uint64_t packed) {
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) throw std::bad_alloc();
  const std::unique_ptr<z_stream, EndInflate> owner(&stream);
  std::array<Bytef, 65536> input{};
  std::array<Bytef, 65536> output{};
  std::uint64_t unpacked = 0;
  for (std::uint64_t left = packed;;) {
    if (stream.avail_in == 0) {
      const auto part = static_cast<std::streamsize>(std::min<std::uint64_t>(left, input.size()));
      if (part == 0 || !file.read(reinterpret_cast<char*>(input.data()), part)) refuse_damaged();
      left -= static_cast<std::uint64_t>(part);
      stream.next_in = input.data();
      stream.avail_in = static_cast<uInt>(part);
    }
    stream.next_out = output.data();
    stream.avail_out = static_cast<uInt>(output.size());
    const int status = inflate(&stream, Z_NO_FLUSH);
    unpacked += output.size() - stream.avail_out;
    if (status == Z_STREAM_END) return unpacked;
    if (status != Z_OK && status != Z_BUF_ERROR) refuse_damaged();
    if (slipfit::reading::is_bomb(unpacked, packed)) {
      throw Refusal("container_too_large the .mat file unpacks to far more than a recording holds; save a part of it");
    }
  }
}

}  // namespace

void check_mat(const std::string& name, std::uint64_t size) {
  constexpr std::uint64_t kHeader = 128;
  constexpr std::uint32_t kCompressed = 15;
  std::ifstream file(name, std::ios::binary);
  std::array<char, kHeader> header{};
  if (!file.read(header.data(), header.size())) refuse_damaged();
  const bool is_swapped = (header[126] == 'M') == (std::endian::native == std::endian::little);
  const auto number = [&](const char* bytes) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes, sizeof(value));
    return is_swapped ? __builtin_bswap32(value) : value;
  };
  for (std::uint64_t place = kHeader; place < size;) {
    std::array<char, 8> tag{};
    file.seekg(static_cast<std::streamoff>(place));
    if (!file.read(tag.data(), tag.size())) refuse_damaged();
    const std::uint64_t bytes = number(tag.data() + 4);
    place += tag.size() + bytes;
    if (place > size) refuse_damaged();
    if (number(tag.data()) == kCompressed) (void)unpacked_size(file, bytes);
  }
}
