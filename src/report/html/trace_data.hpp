#pragma once

#include <string>

#include "report/html/figure.hpp"

namespace slipfit::html {

/// The recording for trace.js, as JSON that may stand in a <script>: force and residual in 65535 levels between their
/// ends (a residual that the fit does not reach is level 65535), two bytes a sample in base64; times as a first and a
/// last, and 32-bit parts of the time between where the clock is uneven; slips and gaps by begin and end, outliers by
/// their time, as such parts, too. Beyond a million samples the lowest and the
/// highest of each group, whose times are then right to two millionths of the duration.
std::string trace_data(const Source& source);

}  // namespace slipfit::html
