#pragma once

#include <compare>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace slipfit {

/// XXH3, 128 bits: the same bytes have the same digest on every machine. It tells files apart and finds damage; it is
/// no protection against somebody who makes two files with the same digest on purpose.
struct Digest {
  std::uint64_t high = 0;
  std::uint64_t low = 0;

  /// "xxh128:" and 32 hexadecimal digits, as `xxh128sum` prints them.
  [[nodiscard]] std::string text() const;
  friend auto operator<=>(const Digest&, const Digest&) = default;  // NOLINT(modernize-use-nullptr): a wrong alarm
};

/// The digest of bytes that come piece by piece.
class Digester {
 public:
  Digester();
  ~Digester();
  Digester(Digester&&) noexcept;
  Digester& operator=(Digester&&) noexcept;
  Digester(const Digester&) = delete;
  Digester& operator=(const Digester&) = delete;

  void add(std::string_view bytes);
  /// Of all bytes so far.
  [[nodiscard]] Digest digest() const;
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

 private:
  struct State;
  std::unique_ptr<State> state_;
  std::uint64_t bytes_ = 0;
};

Digest digest_of(std::string_view bytes);

/// Empty where it is no regular file or cannot be read.
std::optional<Digest> digest_of_file(const std::string& file);

}  // namespace slipfit
