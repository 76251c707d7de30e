#pragma once

#include <string>
#include <string_view>

#include "report/blocks.hpp"
#include "report/html/figure.hpp"
#include "slipfit/report/html.hpp"

namespace slipfit::html {

/// The parts in which pages differ, in HTML except for the title, which is text. Empty parts are left out.
struct PageParts {
  std::string title;
  std::string place;  ///< path and labels, under the title
  std::string kind;   ///< "recording", "sweep" or "batch": for the style sheet
  std::string headline;
  std::string summary;  ///< under the headline
  std::string main;
  std::string scripts;  ///< elements <script>
};
std::string page_from(const PageParts& parts);
/// Returns the line under the title: the path of the file, and its entry in the manifest.
std::string place_of(const Recording& recording);
std::string script_element(std::string_view script);

/// <td> with a quantity rounded by its uncertainty, its interval, the value to sort by, and the status of a parameter.
std::string quantity_cell(const Estimate& SI, double per_SI, const std::string& status = {});
/// A sentence with a capital at its beginning.
std::string capitalised(std::string sentence);
/// "command" with what was typed, for <dl>; empty where nothing was.
std::string command_fact(const std::string& command_line);

// Parts of the page of one recording, as HTML.
std::string motion_sentence(const Source& source);
std::string key_numbers(const Source& source);
/// Warnings, and apart from them the facts among them.
std::string warnings_part(const Warnings& warnings);
std::string parameters_part(const Source& source);
/// The table alone.
std::string parameter_table(const FitResult& fit);
/// The table of a block with its sentences.
std::string block_content(const Block& block);
/// <section> with the block; empty where that is.
std::string block_part(const Block& block);
std::string repeat_part(const Source& source, const ReportOrigin& origin);
/// The recording for trace.js, as JSON that a <script> may contain: force and residual in 65535 levels between their
/// ends (a residual that the fit does not reach is level 65535), two bytes a sample in base64; times as a first and a
/// last, and 32-bit parts of the time between where the clock is uneven; slips and gaps by begin and end, outliers by
/// their time, as such parts, too. Beyond a million samples the lowest and the
/// highest of each group, whose times are then right to two millionths of the duration.
std::string trace_data(const Source& source);
/// The picture with its legend for narrow screens.
std::string picture_of(const chart::Chart& chart, const std::string& id, const std::string& label);
/// <section> with the chart, or with the reason why there is none.
std::string figure_part(const Figure& figure);

}  // namespace slipfit::html
