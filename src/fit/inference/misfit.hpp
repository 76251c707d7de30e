#pragma once

#include <cstddef>
#include <optional>

#include "fit/inference/uncertainty.hpp"
#include "fit/problem/block_fit.hpp"

namespace slipfit::fit {

/// Stretches of equal length from shortly before a slip to shortly after it.
inline constexpr int kSegments = 8;

/// Says where in a slip residuals are the same in every cycle, and how large they are.
struct SegmentMisfit {
  double position = 0.0;  ///< middle of the worst stretch: 0 at the onset, 1 at the end of slip
  double size = 0.0;      ///< mean residual there over the mean onset force, signed
  double chance = 1.0;    ///< of a mean as far from 0 in one of the stretches, by Student's t over the cycles
};

/// Stretch of a sample; empty outside all.
std::optional<std::size_t> segment_of(const CycleState& state, double time_s);

/// Stacks residuals over the segments of the slip. The result is empty where no stretch has a mean that exceeds chance
/// (4.5 standard errors over the cycles) and matters (1 % of the onset force, `tolerated` on top), and below 5 cycles.
std::optional<SegmentMisfit> find_misfit(const BlockFit& fit, double tolerated);

/// Root mean square over the stretches of a slip, over the mean onset force.
struct StackedResidual {
  double size = 0.0;       ///< of the mean residuals over the cycles
  double by_chance = 0.0;  ///< of their standard errors
};

/// The stretches are those of the slips of `phases`, a fit of the same recording or of more of its cycles: two fits
/// compare on the same samples.
StackedResidual stacked_residual(const BlockFit& fit, const BlockFit& phases);

/// Adds the jackknife over the stretches: what the estimates owe to one part of the slip alone. Each row of `moves`:
/// what a refit without one stretch moves the coordinates by.
Uncertainty with_misfit(Uncertainty uncertainty, const Moves& moves);

}  // namespace slipfit::fit
