#pragma once

#include <string>
#include <vector>

#include "io/choice.hpp"
#include "io/layout.hpp"
#include "slipfit/core/result.hpp"
#include "slipfit/io/read_options.hpp"

namespace slipfit::reading {

/// What stands beside time and force: normal force, speed, displacement, numbers of steps, the column of --where. A
/// column that nobody named is used where its name and unit leave no doubt, and is otherwise no reason to refuse a
/// file. Errors: unknown_column, column_not_numeric, unknown_unit, conflicting_options.
Result<Choice> with_side_columns(Choice choice, const Layout& layout, const ReadOptions& options,
                                 const std::string& file);

/// Of several columns that may be the tangential force, those whose quotient with the normal force is the column of
/// friction coefficients; all of them where that does not tell.
std::vector<std::size_t> those_of_coefficient(const Layout& layout, std::vector<std::size_t> candidates);

}  // namespace slipfit::reading
