#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace slipfit::batch {

/// Spreads pieces of work over `shards` so that none is much larger than the others: the largest first, each to the
/// shard with the least so far. Returns the shard of each piece, from 1. Same sizes, same answer, on every machine.
std::vector<std::uint32_t> spread(const std::vector<std::uint64_t>& sizes, std::size_t shards);

}  // namespace slipfit::batch
