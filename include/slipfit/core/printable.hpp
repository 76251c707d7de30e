#pragma once

#include <string>
#include <string_view>

namespace slipfit {

/// Returns one line that a terminal displays as written and that cannot imitate other text: control and format
/// characters and separators of lines and paragraphs (Unicode's categories Cc, Cf, Zl and Zp) are escaped as in JSON
/// (`\u202e`), bytes that are not UTF-8 as `\xff`. A text without them does not change.
std::string printable(std::string_view text);

/// Returns a text of several lines, escaped like printable(); line ends and tabs remain.
std::string printable_lines(std::string_view text);

}  // namespace slipfit
