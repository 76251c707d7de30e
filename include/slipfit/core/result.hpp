#pragma once

#include <string>
#include <utility>
#include <variant>

namespace slipfit {

/// The reason why an input cannot be used. `message` is one line: place, offending value, expectation, remedy.
struct Error {
  std::string code;  ///< snake_case, stable across versions (failures.csv, scripts)
  std::string message;
};

/// A value, or the reason why there is none. Check `ok()` (or convert to bool) before reading either; reading the
/// missing one throws std::bad_variant_access.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : content_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : content_(std::in_place_index<1>, std::move(error)) {}

  [[nodiscard]] bool ok() const { return content_.index() == 0; }
  explicit operator bool() const { return ok(); }

  [[nodiscard]] const T& value() const& { return std::get<0>(content_); }
  [[nodiscard]] T&& value() && { return std::get<0>(std::move(content_)); }
  [[nodiscard]] const Error& error() const { return std::get<1>(content_); }

 private:
  std::variant<T, Error> content_;
};

}  // namespace slipfit
