#pragma once

#include <string>
#include <string_view>

namespace slipfit {

/// One line that a terminal displays as it is written, and that forges no other text: control and format characters
/// and separators of lines and paragraphs (Unicode's categories Cc, Cf, Zl and Zp) are escaped as in JSON (`\u202e`),
/// bytes that are not UTF-8 as `\xff`. A text without them does not change.
std::string printable(std::string_view text);

/// The same for text of several lines: line ends and tabs stay.
std::string printable_lines(std::string_view text);

}  // namespace slipfit
