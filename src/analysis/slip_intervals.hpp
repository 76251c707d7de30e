#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/quantile.hpp"
#include "slipfit/core/estimate.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/core/result.hpp"
#include "slipfit/signal/cycles.hpp"

namespace slipfit {

/// Intervals between slips, without the first slip, without gaps of the clock, and without the few that differ greatly
/// from otherwise regular ones (`broken`: the stage stopped, or samples are missing while the clock continued).
struct Intervals {
  std::vector<double> seconds;
  std::size_t broken = 0;
};

Intervals intervals_of(const Recording& recording, const Segmentation& segmentation);

/// Frequency from the mean interval between slips, in Hz; empty below 3 slips. The interval allows for slips that come
/// in clusters (or regularly): the variance of the mean is that of a stationary series, correlation of neighbours
/// included.
Estimate count_frequency(const Recording& recording, const Segmentation& segmentation);

/// Says how many intervals do not fit a regular rhythm; empty where all do.
std::optional<std::string> broken_rhythm(const Recording& recording, const Segmentation& segmentation);

/// Returns true if the interval between slips differs between two parts of the recording.
bool pace_changes(const Segmentation& segmentation);

/// Says how the interval or the drop changes at the moment that separates the values best; empty where their scatter
/// explains the change.
std::optional<std::string> change_on_the_way(const Segmentation& segmentation);

}  // namespace slipfit
