#pragma once

#include <cstddef>
#include <span>

namespace slipfit {

/// The samples [begin, end).
struct SampleRange {
  std::size_t begin = 0;
  std::size_t end = 0;

  [[nodiscard]] std::size_t size() const { return end - begin; }
  /// Returns this part of a column.
  [[nodiscard]] std::span<const double> of(std::span<const double> column) const {
    return column.subspan(begin, size());
  }
  bool operator==(const SampleRange&) const = default;
};

}  // namespace slipfit
