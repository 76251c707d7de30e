#pragma once

#include <string>
#include <vector>

namespace slipfit::batch {

/// Cells into one line of CSV without its end; quotes where they are needed.
std::string csv_line(const std::vector<std::string>& cells);

/// Text from outside as a cell: what a spreadsheet would run as a formula (= + - @ in front) gets a ' in front.
std::string text_cell(const std::string& text);

}  // namespace slipfit::batch
