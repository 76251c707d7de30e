#pragma once

#include <string>
#include <string_view>
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

/// Returns the charts of the page as JSON for programs that draw them: an object with a chart for each id ("trace",
/// "spectrum", ...): title, guide, why it is absent, and panels with axes, areas, lines, markers and notes. Points are
/// [[x, ...], [y, ...]] in the units of the axes, null where there is a gap; all samples of the trace are there.
/// `which`: only charts whose id begins so.
std::string report_charts(const Recording& recording, const Analysis& analysis, const Background& background,
                          std::string_view which = {});

}  // namespace slipfit
