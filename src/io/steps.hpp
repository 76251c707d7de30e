#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/sample_range.hpp"
#include "io/rows.hpp"

namespace slipfit::reading {

/// A part of a file that was recorded in one go.
struct Step : SampleRange {
  std::size_t number = 1;  ///< the file's own where each has another, else counted from 1
};

/// At least one. A new step begins where a column of step numbers changes, where the line of names stands again, where
/// the clock begins again; where none of these happens, with each level of speed or load.
std::vector<Step> find_steps(const Rows& rows);

/// Whether the steps are one recording all the same: the clock goes on, and speed and load stay.
bool are_one_recording(const Rows& rows, std::span<const Step> steps);

/// Of each step the levels of its speed where it has several, else itself; those of no one speed are left out.
/// Numbered from 1. Without a column of speeds the steps themselves.
std::vector<Step> segments_of_steps(const Rows& rows, std::span<const Step> steps);

/// The first that is about as long as the longest.
const Step& main_step(std::span<const Step> steps);

/// By its number, else by its place. Error: unknown_step.
Step step_with_number(std::span<const Step> steps, std::size_t number, const std::string& file);

}  // namespace slipfit::reading
