#include "io/arrays/mat_elements.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <new>

#include "io/arrays/tables.hpp"

namespace slipfit::reading {
namespace {

template <class Number>
Number number_at(const char* place, MatOrder order) {
  std::array<char, sizeof(Number)> bytes{};
  std::memcpy(bytes.data(), place, bytes.size());
  if (order == MatOrder::Swapped) std::ranges::reverse(bytes);
  Number number{};
  std::memcpy(&number, bytes.data(), bytes.size());
  return number;
}

template <class Number>
std::vector<double> converted(const MatElement& element) {
  if (element.data.size() % sizeof(Number) != 0) refuse_damaged_mat();
  std::vector<double> values(element.data.size() / sizeof(Number));
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = static_cast<double>(number_at<Number>(element.data.data() + i * sizeof(Number), element.order));
  }
  return values;
}

struct EndInflate {
  void operator()(z_stream* state) const { inflateEnd(state); }
};

}  // namespace

void refuse_damaged_mat() {
  throw Refusal({"damaged_container", "the .mat file is damaged or cut off; save it again"});
}

std::vector<MatElement> mat_elements(std::string_view bytes, MatOrder order) {
  constexpr std::size_t kTag = 8;
  constexpr std::size_t kHalf = 4;
  std::vector<MatElement> elements;
  while (!bytes.empty()) {
    if (bytes.size() < kTag) refuse_damaged_mat();
    const auto first = number_at<std::uint32_t>(bytes.data(), order);
    const bool is_small = first >> 16U != 0;  // up to four bytes, which stand in the tag itself
    const std::size_t size = is_small ? first >> 16U : number_at<std::uint32_t>(bytes.data() + kHalf, order);
    const auto type = static_cast<MatType>(is_small ? first & 0xFFFFU : first);
    const std::size_t begin = is_small ? kHalf : kTag;
    if (size > (is_small ? kHalf : bytes.size() - kTag)) refuse_damaged_mat();
    elements.push_back({type, bytes.substr(begin, size), order});
    const std::size_t padding = type == MatType::Compressed ? 0 : (kTag - size % kTag) % kTag;
    bytes.remove_prefix(is_small ? kTag : std::min(begin + size + padding, bytes.size()));
  }
  return elements;
}

std::vector<double> mat_numbers(const MatElement& element) {
  switch (element.type) {
    case MatType::Int8:
      return converted<std::int8_t>(element);
    case MatType::UInt8:
      return converted<std::uint8_t>(element);
    case MatType::Int16:
      return converted<std::int16_t>(element);
    case MatType::UInt16:
      return converted<std::uint16_t>(element);
    case MatType::Int32:
      return converted<std::int32_t>(element);
    case MatType::UInt32:
      return converted<std::uint32_t>(element);
    case MatType::Single:
      return converted<float>(element);
    case MatType::Double:
      return converted<double>(element);
    case MatType::Int64:
      return converted<std::int64_t>(element);
    case MatType::UInt64:
      return converted<std::uint64_t>(element);
    default:
      refuse_damaged_mat();
  }
}

std::string inflated(std::string_view packed) {
  constexpr std::size_t kPiece = std::size_t{256} * 1024;
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) throw std::bad_alloc();
  const std::unique_ptr<z_stream, EndInflate> owner(&stream);
  // zlib does not write to its input.
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast,cppcoreguidelines-pro-type-reinterpret-cast)
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  std::string bytes;
  for (int status = Z_OK; status != Z_STREAM_END;) {
    const std::size_t before = bytes.size();
    bytes.resize(before + kPiece);
    char* const end = bytes.data() + before;
    stream.next_out =
        reinterpret_cast<Bytef*>(end);  // NOLINT(cppcoreguidelines-pro-type-reinterpret-cast): zlib's bytes
    stream.avail_out = static_cast<uInt>(kPiece);
    status = inflate(&stream, Z_NO_FLUSH);
    bytes.resize(before + kPiece - stream.avail_out);
    if (status != Z_OK && status != Z_STREAM_END) refuse_damaged_mat();
    if (is_bomb(bytes.size(), packed.size())) {
      throw Refusal(
          {"container_too_large", "the .mat file unpacks to far more than a recording holds; save a part of it"});
    }
  }
  return bytes;
}

}  // namespace slipfit::reading
