#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "io/layout.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/io/read_options.hpp"

namespace slipfit::reading {

/// "column 2 'force [N]'", "column 2" where it has no name.
std::string describe(const Layout& layout, std::size_t column);

/// "the columns are 1 'time', 2 'Fx', 3 'Fy'".
std::string list_columns(const Layout& layout);

/// Finds a column of numbers by name (exact, then without unit or case) or by its 1-based number. Errors:
/// unknown_column, column_not_numeric.
std::size_t find_column(const Layout& layout, const std::string& wanted, const std::string& option,
                        const std::string& file);

/// A column by its 0-based index, and what turns its numbers into SI.
struct Channel {
  std::size_t column = 0;
  double scale = 1.0;
  ForceQuantity quantity = ForceQuantity::Force_N;  ///< of the force channel
  std::string sentence;                             ///< for Provenance::assumed
  bool is_clock = false;                            ///< of the time: counted from midnight of its first day
  bool is_unit_assumed = false;                     ///< of the time: the file names none
};

/// A filter that reads only rows with this value.
struct WhereFilter {
  std::size_t column = 0;
  std::string text;
  std::optional<double> number;  ///< where the text is one: 4 is 4.0
};

/// The columns to read, and their units.
struct Choice {
  std::optional<Channel> time;  ///< empty: the sample rate is the clock
  Channel force;
  std::optional<Channel> displacement;
  std::optional<Channel> normal_force;
  std::optional<Channel> speed;
  std::optional<Channel> step;  ///< numbers of steps
  std::optional<WhereFilter> where;
  std::vector<std::string> assumed;
  Warnings warnings;
};

/// Errors: unknown_column, column_not_numeric, no_time_column, ambiguous_time_column, no_force_column,
/// ambiguous_force_column, unknown_unit, conflicting_options. `file` is how messages call the file. A displacement over
/// `speed_m_per_s` (0: not known) replaces a missing clock.
Choice choose_columns(const Layout& layout, const ReadOptions& options, double speed_m_per_s, const std::string& file);

}  // namespace slipfit::reading
