#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "io/container/formats.hpp"

namespace slipfit::reading {

/// Columns of numbers out of a container; a shorter one ends with missing readings.
struct NumberTable {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;
};

/// The table as CSV with a line of names. Each number reads back as the same double.
std::unique_ptr<ByteStream> text_of(NumberTable table);

/// Text in memory.
std::unique_ptr<ByteStream> text_of(std::string text);

/// Returns the text as one cell of CSV: on one line, in quotes if necessary.
std::string csv_cell(std::string_view text);

}  // namespace slipfit::reading
