#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace slipfit {

/// The cells with commas between them, without a line end; those that would be taken apart are quoted.
std::string csv_line(const std::vector<std::string>& cells);

/// Returns true if a spreadsheet would run the text as a formula: it begins with = + - or @.
bool is_formula(std::string_view text);

/// Text from outside as a printable cell that a spreadsheet does not run as a formula: such text gets a ' in front.
std::string spreadsheet_cell(std::string_view text);

}  // namespace slipfit
