#include "batch/id_index.hpp"

#include <algorithm>

namespace slipfit::batch {

void IdIndex::add(std::string_view id, std::size_t number) {
  entries_.push_back({digest_of(id), number});
}

void IdIndex::sort() {
  std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) { return a.digest < b.digest; });
}

std::optional<std::size_t> IdIndex::find(std::string_view id) const {
  const Digest wanted = digest_of(id);
  const auto found = std::lower_bound(entries_.begin(), entries_.end(), wanted,
                                      [](const Entry& entry, const Digest& value) { return entry.digest < value; });
  if (found == entries_.end() || found->digest != wanted) return std::nullopt;
  return found->number;
}

std::vector<Digest> IdIndex::repeated() const {
  std::vector<Digest> digests;
  for (std::size_t i = 1; i < entries_.size(); ++i) {
    if (entries_[i].digest == entries_[i - 1].digest) digests.push_back(entries_[i].digest);
  }
  return digests;
}

}  // namespace slipfit::batch
