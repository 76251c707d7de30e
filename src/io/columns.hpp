#pragma once

#include <string>

#include "io/choice.hpp"
#include "io/layout.hpp"
#include "slipfit/core/result.hpp"
#include "slipfit/io/read_options.hpp"

namespace slipfit::reading {

/// Errors: unknown_column, column_not_numeric, no_time_column, ambiguous_time_column, no_force_column,
/// ambiguous_force_column, unknown_unit, conflicting_options. `file` is how messages call the file. A displacement over
/// `speed_m_per_s` (0: not known) stands in for a clock that is missing.
Result<Choice> choose_columns(const Layout& layout, const ReadOptions& options, double speed_m_per_s,
                              const std::string& file);

}  // namespace slipfit::reading
