#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace slipfit::reading {

/// Cells of one column and one shape that look like numbers and could not be read as such.
struct UnreadCells {
  std::size_t count = 0;
  std::size_t column = 0;
  unsigned first_line = 0;
  std::string example;  ///< the first of them
};

/// Counts cells that could not be read by their shape, in which a run of digits counts as one digit: "(0.25)" and
/// "(12.5)" have the same. A program that writes numbers in a way of its own leaves many cells of one shape; damage
/// leaves many shapes.
class UnreadCellCount {
 public:
  /// Cells without a digit, and those with letters (other than the e of an exponent), ':' or '/', do not count.
  void add(std::string_view cell, std::size_t column, unsigned line);
  /// The most frequent ones.
  [[nodiscard]] std::optional<UnreadCells> most() const;

 private:
  std::map<std::pair<std::size_t, std::string>, UnreadCells> by_shape_;  ///< by column and shape
};

}  // namespace slipfit::reading
