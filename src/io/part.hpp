#pragma once

#include <string>
#include <utility>
#include <vector>

#include "io/opened_file.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/io/read_options.hpp"

namespace slipfit::reading {

/// The rows of one recording in the order of time, which never decreases; and what is known and assumed about them.
struct Part {
  Rows rows;
  Conditions conditions;
  Provenance provenance;
  std::size_t in_window = 0;  ///< samples before those out of order were left out
  unsigned first_backward_line = 0;

  void assume(std::string sentence) { provenance.assumed.push_back(std::move(sentence)); }
};

/// Moves the rows of one recording out of the file: the step that was asked for, or the main step if the steps do not
/// form one recording; within it, the window; within that, the samples whose time does not run backwards. Error:
/// unknown_step.
Part take_part(OpenedFile& file);

/// The stretches of one speed each, in every step of the file.
std::vector<Part> take_segments(const Rows& rows);

/// Adds the counts, assumptions and warnings of the file to those of the part. Errors: unread_numbers,
/// time_runs_backwards, window_empty, part_empty, no_number_in_column, too_few_samples, time_constant, time_too_coarse.
void describe_part(Part& part, const OpenedFile& file);

}  // namespace slipfit::reading
