#pragma once

#include <string>
#include <string_view>

#include "report/html/figure.hpp"
#include "slipfit/report/html.hpp"

namespace slipfit::html {

/// What differs between the pages: HTML, but for the title, which is text. Empty parts are left out.
struct PageParts {
  std::string title;
  std::string place;  ///< path and labels, under the title
  std::string kind;   ///< "recording", "sweep" or "batch": for the style sheet
  std::string headline;
  std::string summary;  ///< under the headline
  std::string main;
  std::string library_style;
  std::string credits;  ///< behind the program's version, as text
  std::string scripts;  ///< elements <script>
};
std::string page_from(const PageParts& parts);
/// Under the title: where the file lies, and what the manifest says of it.
std::string place_of(const Recording& recording);
/// Of a file's path: its name; "recording" where there is none.
std::string title_of(const Recording& recording);
std::string script_element(std::string_view script);

/// <td> with a quantity rounded by its uncertainty, its interval, and the value to sort by.
std::string quantity_cell(const Estimate& SI, double per_SI);
/// A sentence with a capital at its beginning.
std::string capitalised(std::string sentence);
/// "command" with what was typed, for <dl>; empty where nothing was.
std::string command_fact(const std::string& command_line);

// Parts of the page of one recording, as HTML.
std::string motion_sentence(const Source& source);
std::string key_numbers(const Source& source);
std::string warnings_part(const Warnings& warnings);
std::string parameters_part(const Source& source);
/// The table alone.
std::string parameter_table(const FitResult& fit);
std::string quality_part(const Source& source);
std::string repeat_part(const Source& source, const ReportOrigin& origin);
/// <section> with the chart, or with the reason why there is none.
std::string figure_part(const Figure& figure);

}  // namespace slipfit::html
