#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace slipfit::batch {

/// Cells into one line of CSV without its end; quotes where they are needed.
std::string csv_line(const std::vector<std::string>& cells);

}  // namespace slipfit::batch
