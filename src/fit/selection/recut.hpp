#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "fit/problem/block_fit.hpp"

namespace slipfit::fit {

/// Says how the cycles of a recording are cut.
struct Cut {
  const Recording& recording;
  const Segmentation& segmentation;
  double half_width_s = 0.0;
  const std::vector<std::size_t>& excluded;  ///< samples, in ascending order
};

/// Those of the cycles that the fit has, in order.
std::vector<CycleData> same_cycles_of(const BlockFit& fit, std::vector<CycleData> cut);

/// Cut again without the slips `bad`, with these lines in the level, near the solution of `fit`, whose cycles make room
/// for the new ones. Empty where too few are left.
std::optional<BlockFit> recut(BlockFit fit, const Cut& cut, const std::vector<std::size_t>& bad,
                              const std::vector<double>& lines_Hz);

/// Returns the fit with the scatter in its sticks computed without its hum.
BlockFit with_hum_in_bins(BlockFit fit, const Cut& cut);

}  // namespace slipfit::fit
