#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace slipfit::batch {

/// Finds the number that belongs to an id, in 16 bytes an id: digests in place of the ids.
class IdIndex {
 public:
  void add(std::string_view id, std::size_t number);
  /// After the last `add`, before any question.
  void sort();
  [[nodiscard]] std::optional<std::size_t> find(std::string_view id) const;
  /// Digests that were added more than once: the ids are the same, or (one chance in 10^7 for a million) seem so.
  [[nodiscard]] std::vector<std::uint64_t> repeated() const;

 private:
  struct Entry {
    std::uint64_t digest = 0;
    std::size_t number = 0;
  };
  std::vector<Entry> entries_;
};

}  // namespace slipfit::batch
