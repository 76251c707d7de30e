#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/sample_range.hpp"
#include "io/rows.hpp"

namespace slipfit::reading {

/// The level of a measured speed or load, without the readings before the start and after the stop.
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

/// A part of a file that was recorded in one go.
struct Step : SampleRange {
  std::size_t number = 1;  ///< the file's own where each has another, else counted from 1
};

/// At least one. A new step begins where a column of step numbers changes, where the header line is repeated, where
/// the clock begins again; where none of these happens, with each level of speed or load.
std::vector<Step> find_steps(const Rows& rows);

/// Returns true if the steps form one recording: the clock continues, and speed and load stay the same.
bool are_one_recording(const Rows& rows, std::span<const Step> steps);

/// Returns the levels of the speed within each step that has several, otherwise the step; those without a constant
/// speed are left out. They are numbered from 1. Without a column of speeds the steps themselves are returned.
std::vector<Step> segments_of_steps(const Rows& rows, std::span<const Step> steps);

/// The first that is about as long as the longest.
const Step& main_step(std::span<const Step> steps);

/// Returns the step by its number, otherwise by its position. Error: unknown_step.
Step step_with_number(std::span<const Step> steps, std::size_t number, const std::string& file);

}  // namespace slipfit::reading
