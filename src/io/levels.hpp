#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/sample_range.hpp"

namespace slipfit::reading {

/// The level that a measured speed or load holds while it is on.
struct Level {
  double value = 0.0;               ///< median
  double standard_deviation = 0.0;  ///< robust, of single readings
  bool is_steady = false;           ///< nearly all blocks of readings lie near the median
};

/// Readings below half of their 90 % level count as "off" (before the start, after the stop). Empty where the column
/// holds nothing but zeros or no numbers.
std::optional<Level> level_of(std::span<const double> values);

/// Returns the speed of a displacement in each of several parts, without sign; parts without duration are left out.
std::vector<double> block_speeds_m_per_s(std::span<const double> time_s, std::span<const double> displacement_m,
                                         std::size_t blocks);

/// The stretches in which the column holds one level each, to the given relative tolerance, where there are several
/// levels; a stretch of less than a twentieth of the samples is none. Empty where the column drifts.
std::vector<SampleRange> stretches_of_levels(std::span<const double> values, double tolerance);

}  // namespace slipfit::reading
