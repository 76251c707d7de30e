#pragma once

#include <compare>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace slipfit {

/// A digest, XXH3 with 128 bits: the same bytes have the same digest on every machine. It distinguishes files and
/// reveals damage; it is not secure against files made on purpose with the same digest.
struct Digest {
  std::uint64_t high = 0;
  std::uint64_t low = 0;

  /// Returns "xxh128:" and 32 hexadecimal digits, as `xxh128sum` prints them.
  [[nodiscard]] std::string text() const;
  friend auto operator<=>(const Digest&, const Digest&) = default;  // NOLINT(modernize-use-nullptr): a wrong alarm
};

/// Computes the digest of bytes that arrive in pieces.
class Digester {
 public:
  Digester();
  ~Digester();
  Digester(Digester&&) noexcept;
  Digester& operator=(Digester&&) noexcept;
  Digester(const Digester&) = delete;
  Digester& operator=(const Digester&) = delete;

  void add(std::string_view bytes);
  /// Returns the digest of all bytes so far.
  [[nodiscard]] Digest digest() const;
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

 private:
  struct State;
  std::unique_ptr<State> state_;
  std::uint64_t bytes_ = 0;
};

Digest digest_of(std::string_view bytes);

/// Returns the digest of a file, or nothing if it is not a regular file or cannot be read.
std::optional<Digest> digest_of_file(const std::string& file);

}  // namespace slipfit
