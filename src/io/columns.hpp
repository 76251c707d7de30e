#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "io/layout.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/core/result.hpp"
#include "slipfit/io/read_options.hpp"

namespace slipfit::reading {

/// A column by its 0-based index, and what turns its numbers into SI.
struct Channel {
  std::size_t column = 0;
  double scale = 1.0;
  ForceQuantity quantity = ForceQuantity::Force_N;  ///< of the force channel
  std::string sentence;                             ///< for Provenance::assumed
};

/// Which columns are read, and how.
struct Choice {
  std::optional<Channel> time;  ///< empty: the sample rate is the clock
  Channel force;
  std::optional<Channel> displacement;
  std::vector<std::string> assumed;
};

/// Errors: unknown_column, column_not_numeric, no_time_column, ambiguous_time_column, no_force_column,
/// ambiguous_force_column, unknown_unit, conflicting_options. `file` is how messages call the file.
Result<Choice> choose_columns(const Layout& layout, const ReadOptions& options, const std::string& file);

}  // namespace slipfit::reading
