#pragma once

#include <string>
#include <vector>

#include "slipfit/analysis.hpp"
#include "slipfit/background.hpp"
#include "slipfit/core/recording.hpp"

namespace slipfit {

/// What a reader needs to repeat the analysis, beside the recording's own conditions.
struct ReportOrigin {
  std::string command_line;  ///< as typed; empty: not by command line
};

/// One self-contained page: no network, readable on paper (docs/report.md). `analysis` should hold the fitted curve
/// (`FitOptions::curve`): without it there is no fit on the trace. Text from outside stays text.
std::string to_html(const Recording& recording, const Analysis& analysis, const Background& background,
                    const ReportOrigin& origin);

struct PictureFile {
  std::string name;  ///< trace.svg, spectrum.svg, ...
  std::string content;
};

/// The charts of the page as SVG files; those that the recording does not allow are left out.
std::vector<PictureFile> report_pictures(const Recording& recording, const Analysis& analysis,
                                         const Background& background);

}  // namespace slipfit
