#include "report/html/markup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "slipfit/core/printable.hpp"

namespace slipfit::html {
namespace {

using Replacement = std::pair<std::string_view, std::string_view>;

constexpr std::array<Replacement, 5> kMarkup{
    {{"&", "&amp;"}, {"<", "&lt;"}, {">", "&gt;"}, {"\"", "&quot;"}, {"'", "&#39;"}}};
constexpr std::array<Replacement, 5> kScript{
    {{"<", "\\u003c"}, {">", "\\u003e"}, {"&", "\\u0026"}, {"\xE2\x80\xA8", "\\u2028"}, {"\xE2\x80\xA9", "\\u2029"}}};

constexpr std::array<Replacement, 8> kSymbols{{{"F_s", "F<sub>s</sub>"},
                                               {"F_k", "F<sub>k</sub>"},
                                               {"w_n^2", "ω<sub>n</sub><sup>2</sup>"},
                                               {"w_n", "ω<sub>n</sub>"},
                                               {"zeta^2", "ζ<sup>2</sup>"},
                                               {"zeta", "ζ"},
                                               {"lambda", "λ"},
                                               {"alpha", "α"}}};

/// Runs without any of the first characters are copied at once: pages hold megabytes that need no replacement.
template <std::size_t count>
std::string replaced(std::string_view content, const std::array<Replacement, count>& replacements) {
  std::string first_characters;
  for (const Replacement& replacement : replacements) first_characters += replacement.first.front();
  std::string result;
  result.reserve(content.size());
  while (!content.empty()) {
    const std::size_t plain = std::min(content.find_first_of(first_characters), content.size());
    result += content.substr(0, plain);
    content.remove_prefix(plain);
    if (content.empty()) break;
    const auto* const found = std::ranges::find_if(
        replacements, [content](const Replacement& r) { return content.substr(0, r.first.size()) == r.first; });
    const bool is_plain = found == replacements.end();
    result += is_plain ? content.substr(0, 1) : found->second;
    content.remove_prefix(is_plain ? 1 : found->first.size());
  }
  return result;
}

const char* class_of(const std::string& heading) {
  return heading.starts_with('#') ? " class=\"number\"" : heading.starts_with('~') ? " class=\"interval\"" : "";
}

}  // namespace

std::string text(std::string_view content) {
  return replaced(printable(content), kMarkup);
}

std::string formula_text(std::string_view content) {
  const std::string symbols = replaced(text(content), kSymbols);
  std::string_view rest(symbols);
  std::string result;
  for (std::size_t at = 0; (at = rest.find("--")) != std::string_view::npos;) {
    const std::size_t end = std::min(rest.find_first_not_of("-abcdefghijklmnopqrstuvwxyz", at), rest.size());
    const bool is_option = end > at + 2;
    result += rest.substr(0, at);
    result += is_option ? fmt::format("<code class=\"option\">{}</code>", rest.substr(at, end - at))
                        : std::string(rest.substr(at, end - at));
    rest.remove_prefix(end);
  }
  return result += rest;
}

std::string script_json(std::string_view json) {
  return replaced(json, kScript);
}

std::string filled(std::string_view page, const std::vector<std::pair<std::string, std::string>>& values) {
  std::string result;
  while (true) {
    const std::size_t open = page.find("{{");
    const std::size_t close = page.find("}}", open == std::string_view::npos ? open : open + 2);
    if (close == std::string_view::npos) return result += page;
    const std::string_view name = page.substr(open + 2, close - open - 2);
    const auto found = std::ranges::find_if(values, [name](const auto& v) { return v.first == name; });
    result += page.substr(0, open);
    result += found == values.end() ? page.substr(open, close + 2 - open) : std::string_view(found->second);
    page.remove_prefix(close + 2);
  }
}

std::string section(std::string_view attributes, std::string_view title, std::string_view content) {
  return fmt::format("<section{}>\n<h2>{}</h2>\n{}</section>\n", attributes, title, content);
}

std::string table(std::string_view attributes, const std::vector<std::string>& headings, std::string_view rows) {
  std::string cells;
  for (const std::string& heading : headings) {
    const bool is_marked = heading.starts_with('#') || heading.starts_with('~');
    cells += fmt::format("<th scope=\"col\"{}>{}</th>", heading.starts_with('#') ? class_of(heading) : "",
                         formula_text(std::string_view(heading).substr(is_marked ? 1 : 0)));
  }
  return fmt::format("<div class=\"wide\"><table{}><thead><tr>{}</tr></thead><tbody>\n{}</tbody></table></div>\n",
                     attributes, cells, rows);
}

std::string table(std::string_view attributes, const std::vector<std::string>& headings,
                  const std::vector<std::vector<std::string>>& rows) {
  std::string markup;
  for (const std::vector<std::string>& cells : rows) {
    markup += "<tr><th scope=\"row\">" + cells.front() + "</th>";
    for (std::size_t i = 1; i < cells.size(); ++i) {
      markup += fmt::format("<td{}>{}</td>", class_of(headings.at(i)), cells[i]);
    }
    markup += "</tr>\n";
  }
  return table(attributes, headings, markup);
}

std::string small(std::string_view content) {
  return content.empty() ? "" : "<small>" + text(content) + "</small>";
}

std::string fact_list(std::string_view facts) {
  return fmt::format("<dl class=\"facts\">\n{}</dl>\n", facts);
}

std::string fact(std::string_view term, std::string_view content) {
  return fmt::format("<dt>{}</dt><dd>{}</dd>\n", text(term), text(content));
}

std::string list(const std::vector<std::string>& items) {
  if (items.empty()) return {};
  std::string lines;
  for (const std::string& item : items) lines += "<li>" + item + "</li>\n";
  return "<ul class=\"plain\">\n" + lines + "</ul>\n";
}

}  // namespace slipfit::html
