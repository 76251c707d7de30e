#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace slipfit::html {

/// Text as text: & < > " ' escaped, control and format characters as \u202e. For content and for attributes in double
/// quotes.
std::string text(std::string_view content);

/// Returns escaped text with typeset symbols (F_s, F_k, w_n, zeta, lambda) and options that are not broken across
/// lines.
std::string formula_text(std::string_view content);

/// A template with {{name}} replaced by the value of that name, unchanged; inserted text is not searched again.
/// A name without a value stays.
std::string filled(std::string_view page, const std::vector<std::pair<std::string, std::string>>& values);

/// JSON for an element <script>: < > & and the line separators U+2028 and U+2029 as \u escapes.
std::string script_json(std::string_view json);

/// <section> with a heading of level 2; `attributes`: ` id="quality"`, content and title are HTML.
std::string section(std::string_view attributes, std::string_view title, std::string_view content);

/// A table in a box that scrolls where it is too wide. `headings`: of the columns, as text; one that begins with '#'
/// is above numbers, with '~' over what stays on one line. Rows are HTML.
std::string table(std::string_view attributes, const std::vector<std::string>& headings, std::string_view rows);

/// Returns a table whose cells are HTML; the first cell names the row.
std::string table(std::string_view attributes, const std::vector<std::string>& headings,
                  const std::vector<std::vector<std::string>>& rows);

/// <small> of text; empty where that is.
std::string small(std::string_view content);

/// <dl> of facts.
std::string fact_list(std::string_view facts);

/// <dt>term</dt><dd>text</dd>
std::string fact(std::string_view term, std::string_view content);

/// <ul> of items that are HTML already; empty text where there are none.
std::string list(const std::vector<std::string>& items);

}  // namespace slipfit::html
