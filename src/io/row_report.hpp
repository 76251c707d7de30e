#pragma once

#include <optional>
#include <string>

#include "io/rows.hpp"
#include "slipfit/core/estimate.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/core/result.hpp"

namespace slipfit::reading {

/// Errors: time_runs_backwards, window_empty, no_number_in_column, too_few_samples, time_constant.
std::optional<Error> check_rows(const Rows& rows, const RowPlan& plan, const std::string& file);

/// What was counted, assumed and is to be warned of.
Provenance describe_rows(const Rows& rows, const RowPlan& plan, const std::string& file);

/// speed_differs_from_displacement, where a displacement column moves steadily at another speed than the stated one.
std::optional<Warning> compare_speeds(const Rows& rows, const RowPlan& plan, double stated_m_per_s);

}  // namespace slipfit::reading
