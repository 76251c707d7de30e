#pragma once

#include <string>
#include <vector>

namespace slipfit {

/// The cells with commas between them, without a line end; those that would be taken apart are quoted.
std::string csv_line(const std::vector<std::string>& cells);

}  // namespace slipfit
