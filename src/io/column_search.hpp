#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "io/layout.hpp"

namespace slipfit::reading {

/// "column 2 'force [N]'", "column 2" where it has no name.
std::string describe(const Layout& layout, std::size_t column);

/// "the columns are 1 'time', 2 'Fx', 3 'Fy'".
std::string list_columns(const Layout& layout);

/// Finds a column with any contents by name (exact, then without unit or case) or by its 1-based number. Error:
/// unknown_column.
std::size_t find_column_of_any(const Layout& layout, const std::string& wanted, const std::string& option,
                               const std::string& file);

/// Finds a column of numbers. Errors: unknown_column, column_not_numeric.
std::size_t find_column(const Layout& layout, const std::string& wanted, const std::string& option,
                        const std::string& file);

/// The columns with the highest score above 0 (several where they tie).
template <class ScoreOf>
std::vector<std::size_t> best_columns(const Layout& layout, const ScoreOf& score_of) {
  std::vector<std::size_t> best;
  int highest = 1;
  for (std::size_t c = 0; c < layout.columns.size(); ++c) {
    const int score = score_of(layout.columns[c], c);
    if (score < highest) continue;
    if (score > highest) best.clear();
    highest = score;
    best.push_back(c);
  }
  return best;
}

/// Finds the column of the time; empty if no column can be it. Error: ambiguous_time_column.
std::optional<std::size_t> find_time_column(const Layout& layout, const std::string& file);

}  // namespace slipfit::reading
