#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "io/cells.hpp"

namespace slipfit::reading {

/// The names row and the units row above the data, as cells; empty where there is none.
struct Header {
  std::vector<std::string_view> names;
  std::vector<std::string_view> units;
  std::string_view line;  ///< that of the names, else that of the units
  std::size_t lines = 0;
};

/// Looks at the two lines above line `data` (an index into `lines`) that hold a letter, a digit or a percent sign.
Header find_header(const std::vector<std::string_view>& lines, std::size_t data, const Dialect& dialect,
                   std::size_t columns);

}  // namespace slipfit::reading
