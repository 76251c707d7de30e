#pragma once

#include <string>
#include <vector>

#include "io/opened_file.hpp"
#include "slipfit/core/estimate.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/io/read_options.hpp"

namespace slipfit::reading {

/// The rows of one recording in the order of time, which never decreases; and what was left out to get there.
struct Part {
  Rows rows;
  std::size_t in_window = 0;  ///< samples before those out of order were left out
  std::size_t backward = 0;
  std::size_t repeating = 0;
  unsigned first_backward_line = 0;
  std::vector<std::string> assumed;
  Warnings warnings;
};

/// The step that was asked for, or the main one of several that are no one recording; of that the window; of that the
/// samples whose time does not run backwards. Error: unknown_step.
Part take_part(Rows rows, const ReadOptions& options, const std::string& file);

/// The stretches of one speed each, in every step of the file.
std::vector<Part> take_segments(const Rows& rows);

/// Checks the part. Errors: unread_numbers, time_runs_backwards, window_empty, part_empty, no_number_in_column,
/// too_few_samples, time_constant.
void check_part(const Part& part, const LoadedFile& file);

/// Counts, assumptions and warnings.
Provenance describe_part(const Part& part, const LoadedFile& file);

}  // namespace slipfit::reading
