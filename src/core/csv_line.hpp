#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace slipfit {

/// The cells with commas between them, without a line end; those that would be taken apart are quoted.
std::string csv_line(const std::vector<std::string>& cells);

/// Text from outside as a printable cell that a spreadsheet does not run as a formula: what begins with = + - or @ gets
/// a ' in front.
std::string spreadsheet_cell(std::string_view text);

}  // namespace slipfit
