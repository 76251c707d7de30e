#pragma once

#include <string>
#include <vector>

#include "slipfit/analysis.hpp"
#include "slipfit/background.hpp"
#include "slipfit/core/recording.hpp"

namespace slipfit {

/// The information that a reader needs to repeat the analysis, in addition to the conditions of the recording.
struct ReportOrigin {
  std::string command_line;  ///< as typed; empty: not by command line
};

/// Writes one self-contained page that needs no network and can be printed (docs/report.md). `analysis` should contain
/// the fitted curve (`FitOptions::curve`), which the trace shows. Text from outside is escaped.
std::string to_html(const Recording& recording, const Analysis& analysis, const Background& background,
                    const ReportOrigin& origin);

struct PictureFile {
  std::string name;  ///< trace.svg, spectrum.svg, ...
  std::string content;
};

/// Returns the charts of the page as SVG files, except those that the recording does not allow.
std::vector<PictureFile> report_pictures(const Recording& recording, const Analysis& analysis,
                                         const Background& background);

}  // namespace slipfit
