#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace slipfit::reading {

/// Thrown for files that are truncated or state a wrong size.
struct Damaged {};

/// Reads bytes and numbers of either byte order from front to end. Throws Damaged past the end.
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
    std::array<char, sizeof(Number)> raw{};
    bytes(raw.size()).copy(raw.data(), raw.size());
    if (order_ != std::endian::native) std::ranges::reverse(raw);
    Number number{};
    std::memcpy(&number, raw.data(), raw.size());  // the browser's library has no std::bit_cast
    return number;
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

/// A kind of number by the code that a format has for it.
template <class Code>
struct NumberType {
  Code code{};
  std::size_t bytes = 0;
  double (*read)(Cursor&) = nullptr;
};

template <class Number, class Code>
constexpr NumberType<Code> number_type(Code code) {
  return {code, sizeof(Number), read_number<Number>};
}

/// Returns the type with this code, or null if it is no number.
template <class Types, class Code>
constexpr auto find_type(const Types& types, const Code& code) {
  const auto found = std::ranges::find_if(types, [&](const auto& type) { return type.code == code; });
  return found == types.end() ? nullptr : &*found;
}

}  // namespace slipfit::reading
