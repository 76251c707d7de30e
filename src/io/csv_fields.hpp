#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace slipfit::reading {

/// The fields of one line of CSV: blanks around them go, quotes go, "" inside quotes is one quote. Nothing where a
/// quote is not closed, or is followed by more text.
std::optional<std::vector<std::string>> csv_fields(std::string_view line, char delimiter);

}  // namespace slipfit::reading
