#pragma once

#include <string>
#include <string_view>

namespace slipfit::reading {

bool is_utf8(std::string_view text);

/// UTF-8 as it is; anything else is taken for Latin-1 and converted.
std::string to_utf8(std::string_view text);

/// One line of valid UTF-8: control characters are shown as \n, \t or \x1b.
std::string printable(std::string_view text);

/// "1 row", "12 rows".
std::string counted(std::size_t count, std::string_view noun);

}  // namespace slipfit::reading
