#include "batch/shards.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <queue>
#include <utility>

namespace slipfit::batch {

std::vector<std::uint32_t> spread(const std::vector<std::uint64_t>& sizes, std::size_t shards) {
  std::vector<std::uint32_t> largest_first(sizes.size());
  std::iota(largest_first.begin(), largest_first.end(), 0U);
  std::stable_sort(largest_first.begin(), largest_first.end(),
                   [&sizes](std::uint32_t a, std::uint32_t b) { return sizes[a] > sizes[b]; });
  using Load = std::pair<std::uint64_t, std::uint32_t>;  // so far, shard
  std::priority_queue<Load, std::vector<Load>, std::greater<>> loads;
  for (std::uint32_t shard = 1; shard <= shards; ++shard) loads.emplace(0, shard);
  std::vector<std::uint32_t> shard_of(sizes.size());
  for (const std::uint32_t piece : largest_first) {
    const auto [load, shard] = loads.top();
    loads.pop();
    shard_of[piece] = shard;
    loads.emplace(load + sizes[piece], shard);
  }
  return shard_of;
}

}  // namespace slipfit::batch
