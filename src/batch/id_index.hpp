#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "slipfit/core/digest.hpp"

namespace slipfit::batch {

/// Finds the number that belongs to an id, in 24 bytes an id: digests in place of the ids.
class IdIndex {
 public:
  void add(std::string_view id, std::size_t number);
  /// After the last `add`, before any question.
  void sort();
  [[nodiscard]] std::optional<std::size_t> find(std::string_view id) const;
  /// Digests of the ids that were added more than once.
  [[nodiscard]] std::vector<Digest> repeated() const;

 private:
  struct Entry {
    Digest digest;
    std::size_t number = 0;
  };
  std::vector<Entry> entries_;
};

}  // namespace slipfit::batch
