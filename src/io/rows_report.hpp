#pragma once

#include <optional>
#include <string>

#include "io/part.hpp"
#include "io/rows.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/core/result.hpp"

namespace slipfit::reading {

/// Errors: time_runs_backwards, window_empty, part_empty, no_number_in_column, too_few_samples, time_constant.
std::optional<Error> check_part(const Part& part, const RowPlan& plan, const std::string& file);

/// Counts, assumptions and warnings.
Provenance describe_part(const Part& part, const RowPlan& plan, const std::string& file);

}  // namespace slipfit::reading
