#include "report/html/page.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <utility>
#include <vector>

#include "analysis/rules.hpp"
#include "chart/svg.hpp"
#include "report/blocks.hpp"
#include "report/html/assets.hpp"
#include "report/names.hpp"
#include "slipfit/core/printable.hpp"

namespace slipfit::html {
namespace {

using Replacement = std::pair<std::string_view, std::string_view>;

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

/// The class that the mark of a heading gives to its column.
std::string class_of(const std::string& heading) {
  return heading.starts_with('#') ? " class=\"number\"" : heading.starts_with('~') ? " class=\"interval\"" : "";
}

}  // namespace

std::string text(std::string_view content) {
  return chart::escaped(printable(content));
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

std::string sentence_text(std::string_view content) {
  std::string sentence = formula_text(content);
  if (!sentence.empty())
    sentence.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(sentence.front())));
  return sentence;
}

std::string script_json(std::string_view json) {
  return replaced(json, kScript);
}

std::string section(std::string_view attributes, std::string_view title, std::string_view content) {
  return fmt::format("<section{}>\n<h2>{}</h2>\n{}</section>\n", attributes, title, content);
}

std::string table(std::string_view attributes, const std::vector<std::string>& headings,
                  const std::vector<std::vector<Cell>>& rows) {
  std::string head;
  for (const std::string& heading : headings) {
    const std::string css_class = class_of(heading);
    head += fmt::format("<th scope=\"col\"{}>{}</th>", heading.starts_with('#') ? css_class : "",
                        formula_text(std::string_view(heading).substr(css_class.empty() ? 0 : 1)));
  }
  std::string body;
  for (const std::vector<Cell>& cells : rows) {
    body += fmt::format("<tr><th scope=\"row\">{}</th>", cells.front().content);
    for (std::size_t i = 1; i < cells.size(); ++i) {
      body += fmt::format("<td{}{}>{}</td>", class_of(headings.at(i)), cells[i].attributes, cells[i].content);
    }
    body += "</tr>\n";
  }
  return fmt::format("<div class=\"wide\"><table{}><thead><tr>{}</tr></thead><tbody>\n{}</tbody></table></div>\n",
                     attributes, head, body);
}

Cell quantity_cell(const Estimate& SI, double per_SI, const std::string& status) {
  const EstimateRow shown = estimate_row(SI, DisplayUnit{per_SI, ""});
  return {
      text(shown.value) + small(shown.interval) + (status.empty() ? "" : "<small>" + status_mark(status) + "</small>"),
      fmt::format(" data-value=\"{}\"", SI.value ? fmt::format("{}", *SI.value) : std::string())};
}

std::string status_mark(std::string_view status) {
  return fmt::format(R"(<span class="status {0}">{0}</span>)", text(status));
}

std::string small(std::string_view content) {
  return content.empty() ? "" : "<small>" + text(content) + "</small>";
}

std::string note(std::string_view content) {
  return content.empty() ? "" : "<span class=\"note\">" + formula_text(content) + "</span>";
}

std::string absent(std::string_view content) {
  return fmt::format("<p class=\"absent\">{}</p>\n", formula_text(content));
}

std::string fact_list(std::string_view facts) {
  return fmt::format("<dl class=\"facts\">\n{}</dl>\n", facts);
}

std::string fact(std::string_view term, std::string_view content) {
  return fmt::format("<dt>{}</dt><dd>{}</dd>\n", text(term), text(content));
}

std::string code_fact(std::string_view term, std::string_view content) {
  return fmt::format("<dt>{}</dt><dd><code>{}</code></dd>\n", text(term), text(content));
}

std::string list(const std::vector<std::string>& items) {
  if (items.empty()) return {};
  std::string lines;
  for (const std::string& item : items) lines += "<li>" + item + "</li>\n";
  return "<ul class=\"plain\">\n" + lines + "</ul>\n";
}

std::string page_from(const PageParts& parts) {
  return fmt::format(fmt::runtime(assets::page()), fmt::arg("title", text(parts.title)), fmt::arg("place", parts.place),
                     fmt::arg("style", assets::style()), fmt::arg("kind", parts.kind),
                     fmt::arg("headline", parts.headline), fmt::arg("summary", parts.summary),
                     fmt::arg("main", parts.main), fmt::arg("version", SLIPFIT_VERSION),
                     fmt::arg("scripts", parts.scripts + script_element(assets::save_script())));
}

std::string script_element(std::string_view script) {
  return fmt::format("<script>{}</script>\n", script);
}

std::string warnings_part(const Warnings& warnings) {
  std::string doubts;
  std::string facts;
  for (const Warning& warning : warnings) {
    (is_fact(warning) ? facts : doubts) +=
        fmt::format("<li>{} <code>{}</code></li>\n", sentence_text(warning.message), text(warning.code));
  }
  const auto box = [](const char* kind, const char* title, const std::string& items) {
    if (items.empty()) return items;
    return fmt::format("<div class=\"{}\" role=\"note\"><strong>{}</strong>\n<ul>\n{}</ul></div>\n", kind, title,
                       items);
  };
  return box("warnings", "Warnings", doubts) + box("warnings facts-known", "Accounted for in the analysis", facts);
}

std::string parameter_table(const FitResult& fit) {
  std::vector<std::vector<Cell>> rows;
  for (const ShownParameter& parameter : shown_parameters(fit)) {
    rows.push_back({formula_text(parameter.words), text(parameter.numbers.value), text(parameter.numbers.unit),
                    text(parameter.numbers.interval), status_mark(name_of(parameter.status)) + note(parameter.note)});
  }
  return table(" class=\"parameters\"", {"parameter", "#value", "~unit", "~95 % interval", "status"}, rows) +
         list(status_meanings(fit.parameters));
}

std::string block_content(const Block& block) {
  std::vector<std::vector<Cell>> rows;
  for (const Row& row : block.rows) {
    rows.push_back(
        {formula_text(row.label), text(row.value), text(row.unit), text(row.interval), sentence_text(row.note)});
  }
  std::vector<std::string> sentences;
  for (const std::string& sentence : block.sentences) sentences.push_back(sentence_text(sentence));
  return (rows.empty() ? "" : table(" class=\"parameters\"", {"", "#", "~", "~", ""}, rows)) + list(sentences);
}

std::string block_part(const Block& block) {
  if (block.empty()) return {};
  return section(fmt::format(" id=\"{}\" class=\"flows\"", block.id), text(block.title), block_content(block));
}

std::string repeat_part(std::string_view attributes, const std::string& command_line, const std::string& facts,
                        const std::string& more) {
  return section(fmt::format(" id=\"repeat\"{}", attributes), "To repeat this",
                 fact_list(fact("program", fmt::format("slipfit {}", SLIPFIT_VERSION)) +
                           (command_line.empty() ? "" : code_fact("command", command_line)) + facts) +
                     more);
}

std::string picture_of(const chart::Chart& chart, const std::string& id, const std::string& label) {
  return to_page_legend(chart, id) + to_page_svg(chart, {id, label});
}

std::string figure_part(const Figure& figure) {
  const std::string content =
      figure.chart ? fmt::format("<p class=\"guide\">{}</p>\n<figure>{}</figure>\n", formula_text(figure.guide),
                                 picture_of(*figure.chart, figure.id, figure.label))
                   : absent(figure.absent);
  return section(fmt::format(" id=\"{}-section\"", figure.id), text(figure.title), content);
}

}  // namespace slipfit::html
