#pragma once

#include <string>
#include <string_view>

#include "slipfit/analysis.hpp"
#include "slipfit/core/recording.hpp"

namespace slipfit {

/// For people: kind of motion, parameters with intervals and status, spacing (measured, kept apart from predicted),
/// warnings.
std::string to_text(const Recording& recording, const Analysis& analysis);

/// The text with line breaks and other control characters as '?': a file's name cannot forge a second line of output.
std::string one_line(std::string_view text);

}  // namespace slipfit
