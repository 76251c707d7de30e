#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "report/blocks.hpp"
#include "report/html/figure.hpp"
#include "slipfit/report/html.hpp"

namespace slipfit::html {

/// Text as text: & < > " ' escaped, control and format characters as \u202e. For content and for attributes in double
/// quotes.
std::string text(std::string_view content);

/// Returns escaped text with typeset symbols (F_s, F_k, w_n, zeta, lambda) and options that are not broken across
/// lines.
std::string formula_text(std::string_view content);
/// Returns formula_text with a capital at its beginning.
std::string sentence_text(std::string_view content);

/// JSON for an element <script>: < > & and the line separators U+2028 and U+2029 as \u escapes.
std::string script_json(std::string_view json);

/// <section> with a heading of level 2; `attributes`: ` id="quality"`, content and title are HTML.
std::string section(std::string_view attributes, std::string_view title, std::string_view content);

/// A cell of a table: HTML.
struct Cell {
  Cell(std::string html, std::string more_attributes = {})
      : content(std::move(html)), attributes(std::move(more_attributes)) {}
  std::string content;
  std::string attributes;  ///< each with a leading blank
};

/// A table in a box that scrolls where it is too wide; the first cell of a row names it. `headings` are those of the
/// columns, as text: '#' in front marks a column of numbers, '~' one whose cells stay on one line.
std::string table(std::string_view attributes, const std::vector<std::string>& headings,
                  const std::vector<std::vector<Cell>>& rows);

/// A quantity rounded by its uncertainty, its interval, the value to sort by, and the status of a parameter.
Cell quantity_cell(const Estimate& SI, double per_SI, const std::string& status = {});

/// <span> with the status of a parameter and its mark.
std::string status_mark(std::string_view status);
/// <small> of text; empty where that is.
std::string small(std::string_view content);
/// <span class="note"> of text; empty where that is.
std::string note(std::string_view content);
/// <p class="absent"> of text: why something is not there.
std::string absent(std::string_view content);

/// <dl> of facts.
std::string fact_list(std::string_view facts);

/// <dt>term</dt><dd>text</dd>
std::string fact(std::string_view term, std::string_view content);
/// <dt>term</dt><dd><code>text</code></dd>
std::string code_fact(std::string_view term, std::string_view content);

/// <ul> of items that are HTML already; empty text where there are none.
std::string list(const std::vector<std::string>& items);

/// The parts in which pages differ, in HTML except for the title, which is text. Empty parts are left out.
struct PageParts {
  std::string title;
  std::string kind;     ///< "recording", "sweep" or "batch": for the style sheet
  std::string place{};  ///< path and labels, under the title
  std::string headline;
  std::string summary{};  ///< under the headline
  std::string main;
  std::string scripts{};  ///< elements <script>
};
std::string page_from(const PageParts& parts);
std::string script_element(std::string_view script);

// Parts of several pages, as HTML.

/// Warnings, and apart from them the facts among them.
std::string warnings_part(const Warnings& warnings);
/// The table alone.
std::string parameter_table(const FitResult& fit);
/// The table of a block with its sentences.
std::string block_content(const Block& block);
/// <section> with the block; empty where that is.
std::string block_part(const Block& block);
/// <section> with the program, the command as typed (empty: not by command line), further facts, and what follows them.
std::string repeat_part(std::string_view attributes, const std::string& command_line, const std::string& facts,
                        const std::string& more = {});
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
