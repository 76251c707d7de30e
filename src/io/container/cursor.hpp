#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace slipfit::reading {

/// Thrown for files that are truncated or state a wrong size.
struct Damaged {};

/// Reads bytes and numbers of either byte order from front to end; throws Damaged behind it.
class Cursor {
 public:
  Cursor(std::string_view bytes, std::endian order) : rest_(bytes), order_(order) {}

  std::string_view bytes(std::uint64_t size) {
    if (size > rest_.size()) throw Damaged{};
    const auto taken = rest_.substr(0, static_cast<std::size_t>(size));
    rest_.remove_prefix(taken.size());
    return taken;
  }
  template <class Number>
  Number number() {
    std::string raw(bytes(sizeof(Number)));
    if (order_ != std::endian::native) std::ranges::reverse(raw);
    Number value{};
    std::memcpy(&value, raw.data(), sizeof(Number));
    return value;
  }
  [[nodiscard]] std::string_view rest() const { return rest_; }
  std::string text() { return std::string(bytes(number<std::uint32_t>())); }

 private:
  std::string_view rest_;
  std::endian order_;
};

template <class Number>
double read_number(Cursor& cursor) {
  return static_cast<double>(cursor.number<Number>());
}

}  // namespace slipfit::reading
