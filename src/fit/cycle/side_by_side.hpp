#pragma once

#include <cstddef>

#include "core/parallel.hpp"

namespace slipfit::fit {

/// Returns whether work on so many samples is worth the start of a second thread. Their residuals take 3 ms at the
/// limit. Below it threads take as long to start and to share the cache as they save.
inline bool pays_side_by_side(std::size_t samples) {
  constexpr std::size_t kLarge = 60000;
  return samples >= kLarge && usable_processors() > 1;
}

/// Calls f(begin, end) for ranges of neighbouring cycles that together make [0, cycles): side by side where the cycles
/// have so many samples together that a second thread is worth its start, else once. `f` must not change what another
/// range reads or writes; sums over cycles are to be formed afterwards, in the order of the cycles.
template <class F>
void for_cycles(std::size_t cycles, std::size_t samples, const F& f) {
  constexpr std::size_t kRanges = 16;  // several for each processor: others may use one of them, too
  if (cycles == 0) return;
  for_ranges(cycles, pays_side_by_side(samples) ? 1 + cycles / kRanges : cycles, f);
}

}  // namespace slipfit::fit
