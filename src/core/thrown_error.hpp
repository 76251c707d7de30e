#pragma once

#include <stdexcept>
#include <utility>

#include "slipfit/core/result.hpp"

namespace slipfit {

/// An error on its way out of deep calls; the public function that began them returns it.
class ThrownError : public std::runtime_error {
 public:
  explicit ThrownError(Error error) : std::runtime_error(error.message), error_(std::move(error)) {}
  [[nodiscard]] const Error& error() const { return error_; }

 private:
  Error error_;
};

/// Returns the value of `make()`, or the error that it throws.
template <class Make>
auto result_of(const Make& make) -> Result<decltype(make())> {
  try {
    return make();
  } catch (const ThrownError& thrown) {
    return thrown.error();
  }
}

template <class T>
T value_or_throw(Result<T> result) {
  if (!result) throw ThrownError(result.error());
  return std::move(result).value();
}

}  // namespace slipfit
