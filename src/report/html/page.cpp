#include "report/html/page.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "analysis/rules.hpp"
#include "report/blocks.hpp"
#include "report/html/assets.hpp"
#include "report/html/figure.hpp"
#include "report/json_values.hpp"
#include "report/names.hpp"
#include "report/quantity_rows.hpp"
#include "report/text_sections.hpp"
#include "slipfit/core/printable.hpp"
#include "slipfit/report/text.hpp"

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

namespace slipfit {

namespace html {

Source source_of(const Recording& recording, const Analysis& analysis, const Background& background) {
  return {recording,
          analysis,
          background,
          force_unit_of(recording),
          fitted_force(recording, analysis),
          force_without_interference(recording, analysis)};
}

bool shows_cycles(const Analysis& analysis) {
  return analysis.motion != MotionClass::SteadySliding;
}

bool has_fitted_curve(const Analysis& analysis) {
  return shows_cycles(analysis) && analysis.fit && !analysis.fit->curve.empty();
}

std::vector<Figure> figures_of(const Source& source) {
  return {trace_figure(source),     spectrum_figure(source),  cycles_figure(source),
          residuals_figure(source), evolution_figure(source), pairs_figure(source),
          map_figure(source),       speed_figure(source),     pattern_figure(source)};
}

namespace {

/// The chart, and the interactive trace that the script shows in its place where it can.
std::string trace_part(const Figure& figure, const Source& source) {
  return filled(assets::trace_part(),
                {{"title", text(figure.title)},
                 {"guide", formula_text(figure.guide)},
                 {"label", text(figure.label)},
                 {"slips_key", shows_cycles(source.analysis) ? "<span class=\"key slips\"></span>slips" : ""},
                 {"fit_key", has_fitted_curve(source.analysis) ? "<span class=\"key fit\"></span>fit" : ""},
                 {"chart", picture_of(*figure.chart, figure.id, figure.label)}});
}

/// The charts in their order; those that the recording does not allow are listed after them, in a few lines.
std::string figures_part(std::span<const Figure> figures) {
  std::string parts;
  std::string absent;
  for (const Figure& figure : figures) {
    if (figure.chart) {
      parts += figure_part(figure);
    } else {
      absent += "<dt>" + text(figure.title) + "</dt><dd>" + formula_text(figure.absent) + "</dd>\n";
    }
  }
  if (absent.empty()) return parts;
  return parts + section(" id=\"absent\"", "Charts that are not available", fact_list(absent));
}

/// The models that were compared, and correlated parameters; nothing in steady sliding.
std::string models_part(const Source& source) {
  if (!source.analysis.fit || !shows_cycles(source.analysis)) return {};
  const FitResult& fit = *source.analysis.fit;
  return block_part(models_block(fit, source.recording.conditions().quantity)) + block_part(correlations_block(fit));
}

/// Tables that the text report has, too, folded away.
std::string numbers_part(const Source& source) {
  std::string tables;
  for (const Block& block : number_blocks(source.recording, source.analysis))
    tables += "<h3>" + text(block.title) + "</h3>\n" + block_content(block);
  return section(" class=\"flows\" id=\"numbers\"", "All numbers",
                 "<details><summary>Frequency, cycles, spacing, prediction and tests as tables</summary>\n" + tables +
                     "</details>\n");
}

}  // namespace

std::string page_from(const PageParts& parts) {
  return filled(assets::page(), {{"title", text(parts.title)},
                                 {"place", parts.place},
                                 {"style", std::string(assets::style())},
                                 {"kind", parts.kind},
                                 {"headline", parts.headline},
                                 {"summary", parts.summary},
                                 {"main", parts.main},
                                 {"version", SLIPFIT_VERSION},
                                 {"scripts", parts.scripts + script_element(assets::save_script())}});
}

namespace {

/// The name of the file; "recording" where there is none.
std::string title_of(const Recording& recording) {
  const std::string name = std::filesystem::path(recording.provenance().file).filename().string();
  return name.empty() ? "recording" : name;
}

}  // namespace

std::string picture_of(const chart::Chart& chart, const std::string& id, const std::string& label) {
  return to_page_legend(chart, id) + to_page_svg(chart, {id, label});
}

std::string place_of(const Recording& recording) {
  const std::string& file = recording.provenance().file;
  const Labels& labels = recording.conditions().labels;
  std::string place = file == title_of(recording) || file.empty() ? "" : "<p class=\"file\">" + text(file) + "</p>\n";
  std::string facts;
  for (const auto& [term, label] : {std::pair{"sample", &labels.sample},
                                    {"material", &labels.material},
                                    {"operator", &labels.operator_name},
                                    {"group", &labels.group}}) {
    if (!label->empty()) facts += (facts.empty() ? "" : " · ") + fmt::format("{}: {}", term, text(*label));
  }
  return facts.empty() ? place : place + "<p class=\"file\">" + facts + "</p>\n";
}

std::string script_element(std::string_view script) {
  return "<script>" + std::string(script) + "</script>\n";
}

std::string figure_part(const Figure& figure) {
  const std::string content =
      figure.chart ? fmt::format("<p class=\"guide\">{}</p>\n<figure>{}</figure>\n", formula_text(figure.guide),
                                 picture_of(*figure.chart, figure.id, figure.label))
                   : fmt::format("<p class=\"absent\">{}</p>\n", formula_text(figure.absent));
  return section(fmt::format(" id=\"{}-section\"", figure.id), text(figure.title), content);
}

}  // namespace html

std::string to_html(const Recording& recording, const Analysis& analysis, const Background& background,
                    const ReportOrigin& origin) {
  const html::Source source = html::source_of(recording, analysis, background);
  html::PageParts page;
  page.title = html::title_of(recording);
  page.place = html::place_of(recording);
  page.kind = "recording";
  page.headline = html::motion_sentence(source);
  page.summary = "<p class=\"reason\">" + html::capitalised(html::formula_text(analysis.motion_reason)) + "</p>\n" +
                 html::key_numbers(source) + html::warnings_part(analysis.warnings);
  const std::vector<html::Figure> figures = html::figures_of(source);
  page.main = html::trace_part(figures.front(), source) + html::parameters_part(source) +
              html::block_part(coefficients_block(analysis.coefficients)) +
              html::figures_part(std::span(figures).subspan(1)) + html::models_part(source) +
              html::block_part(quality_block(recording, analysis)) + html::numbers_part(source) +
              html::repeat_part(source, origin);
  page.scripts = R"(<script type="application/json" id="trace-data">)" + html::trace_data(source) + "</script>\n" +
                 html::script_element(assets::trace_script());
  return html::page_from(page);
}

std::vector<PictureFile> report_pictures(const Recording& recording, const Analysis& analysis,
                                         const Background& background) {
  std::vector<PictureFile> files;
  for (const html::Figure& figure : html::figures_of(html::source_of(recording, analysis, background))) {
    if (figure.chart) files.push_back({figure.id + ".svg", to_svg(*figure.chart)});
  }
  return files;
}

}  // namespace slipfit

namespace slipfit::html {

namespace {

std::string status_mark(std::string_view status) {
  return status.empty() ? "" : fmt::format(R"(<small><span class="status {0}">{0}</span></small>)", text(status));
}

/// A headline number: its value, interval and status. `unknown_text` replaces a value that is not known.
std::string key_number(std::string_view words, const EstimateRow& row, std::string_view status,
                       const std::string& unknown_text = "not known") {
  const std::string shown = row.value == "-" ? unknown_text : row.value + (row.unit.empty() ? "" : " " + row.unit);
  const std::string mark = row.value == "-" ? "" : status_mark(status);
  return fmt::format("<div><dt>{}</dt><dd>{}{}{}</dd></div>\n", formula_text(words), text(shown), small(row.interval),
                     mark);
}

/// The headline number of a fitted parameter.
std::string key_parameter(const FitResult& fit, ParameterId id) {
  const Parameter* const parameter = fit.find(id);
  if (parameter == nullptr) return key_number(info(id).words, estimate_row(Estimate{}, std::string()), {});
  return key_number(info(id).words, parameter_row(*parameter), name_of(parameter->status));
}

/// The critical speed; where it is not known, stick-slip at the speed of the recording is a lower bound.
std::string key_critical_speed(const Source& source) {
  const Conditions& conditions = source.recording.conditions();
  const Quantity& quantity = quantity_with_key("critical_speed_m_per_s");
  const bool sticks = source.analysis.motion == MotionClass::StickSlip;
  const Parameter* const zeta = source.analysis.fit->find(ParameterId::DampingRatio);  // on which it depends
  return key_number(quantity.words, estimate_row(quantity, source.analysis.derived.critical_speed_m_per_s, conditions),
                    zeta != nullptr ? name_of(zeta->status) : "derived",
                    sticks ? "above " + speed_text(conditions) : "not known");
}

std::vector<std::string> each(const std::vector<std::string>& sentences, std::string (*to_markup)(std::string_view)) {
  std::vector<std::string> items;
  items.reserve(sentences.size());
  for (const std::string& sentence : sentences) items.push_back(to_markup(sentence));
  return items;
}

}  // namespace

std::string quantity_cell(const Estimate& SI, double per_SI, const std::string& status) {
  const EstimateRow shown = estimate_row(SI, DisplayUnit{per_SI, ""});
  const std::string value = SI.value ? fmt::format("{}", *SI.value) : std::string();
  return fmt::format(R"(<td class="number" data-value="{}">{}{}{}</td>)", value, text(shown.value),
                     small(shown.interval), status_mark(status));
}

std::string capitalised(std::string sentence) {
  if (!sentence.empty())
    sentence.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(sentence.front())));
  return sentence;
}

std::string command_fact(const std::string& command_line) {
  return command_line.empty() ? "" : "<dt>command</dt><dd><code>" + text(command_line) + "</code></dd>\n";
}

std::string motion_sentence(const Source& source) {
  const Analysis& analysis = source.analysis;
  const Estimate& frequency = analysis.frequency.quoted;
  const std::string rate = frequency.value ? unbroken(with_error(frequency) + " Hz") : std::string();
  const std::string speed = unbroken(speed_text(source.recording.conditions()));
  switch (analysis.motion) {
    case MotionClass::StickSlip: {
      if (rate.empty()) return text("Stick-slip of undetermined frequency.");
      const Estimate& spacing = analysis.derived.pattern_spacing_m;
      const std::string pattern =
          spacing.value ? fmt::format(" a pattern of {} spacing at", quantity_of(spacing, "m")) : std::string(" at");
      return text(fmt::format("Stick-slip at {}:{} {}.", rate, pattern, speed));
    }
    case MotionClass::SteadySliding:
      return text(fmt::format("Steady sliding at {}: no stick-slip, no pattern.", speed));
    case MotionClass::OscillatorySlip:
      return text(fmt::format("Oscillatory slip{}: almost no sticks.", rate.empty() ? "" : " at " + rate));
    case MotionClass::Undetermined:
      break;
  }
  return "The data do not determine whether this is stick-slip.";
}

std::string key_numbers(const Source& source) {
  const Analysis& analysis = source.analysis;
  if (analysis.motion == MotionClass::SteadySliding) return {};
  const Conditions& conditions = source.recording.conditions();
  const auto measured = [&conditions](const Quantity& quantity, const Estimate& estimate) {
    return key_number(quantity.words, estimate_row(quantity, estimate, conditions), "measured");
  };
  std::string numbers =
      measured(kFrequency, analysis.frequency.quoted) + measured(kMeasured.front(), analysis.derived.pattern_spacing_m);
  if (analysis.fit) {
    numbers += key_parameter(*analysis.fit, ParameterId::Stiffness) +
               key_parameter(*analysis.fit, ParameterId::DampingRatio) + key_critical_speed(source);
  }
  return "<dl class=\"keys\">\n" + numbers + "</dl>\n<p class=\"guide\">In brackets: 95 % intervals.</p>\n";
}

std::string warnings_part(const Warnings& warnings) {
  std::string doubts;
  std::string facts;
  for (const Warning& warning : warnings) {
    (is_fact(warning) ? facts : doubts) +=
        fmt::format("<li>{} <code>{}</code></li>\n", capitalised(formula_text(warning.message)), text(warning.code));
  }
  const auto box = [](const char* kind, const char* title, const std::string& items) {
    if (items.empty()) return items;
    return fmt::format("<div class=\"{}\" role=\"note\"><strong>{}</strong>\n<ul>\n{}</ul></div>\n", kind, title,
                       items);
  };
  return box("warnings", "Warnings", doubts) + box("warnings facts-known", "Accounted for in the analysis", facts);
}

std::string parameter_table(const FitResult& fit) {
  std::vector<std::vector<std::string>> rows;
  for (const ShownParameter& parameter : shown_parameters(fit)) {
    const std::string note =
        parameter.note.empty() ? "" : "<span class=\"note\">" + formula_text(parameter.note) + "</span>";
    rows.push_back({formula_text(parameter.words), text(parameter.numbers.value), text(parameter.numbers.unit),
                    text(parameter.numbers.interval),
                    fmt::format("<span class=\"status {0}\">{0}</span>{1}", name_of(parameter.status), note)});
  }
  return table(" class=\"parameters\"", {"parameter", "#value", "~unit", "~95 % interval", "status"}, rows) +
         list(each(status_meanings(fit.parameters), text));
}

std::string block_content(const Block& block) {
  std::vector<std::vector<std::string>> rows;
  for (const Row& row : block.rows) {
    rows.push_back({formula_text(row.label), text(row.value), text(row.unit), text(row.interval),
                    capitalised(formula_text(row.note))});
  }
  std::vector<std::string> sentences;
  for (const std::string& sentence : block.sentences) sentences.push_back(capitalised(formula_text(sentence)));
  return (rows.empty() ? "" : table(" class=\"parameters\"", {"", "#", "~", "~", ""}, rows)) + list(sentences);
}

std::string block_part(const Block& block) {
  if (block.empty()) return {};
  return section(fmt::format(" id=\"{}\" class=\"flows\"", block.id), text(block.title), block_content(block));
}

std::string parameters_part(const Source& source) {
  const Analysis& analysis = source.analysis;
  const auto part = [](const std::string& content) {
    return section(" id=\"parameters\"", "Parameters of the model", content);
  };
  if (!analysis.fit || analysis.motion == MotionClass::SteadySliding) {
    const char* why = analysis.motion == MotionClass::SteadySliding
                          ? "None: the model describes stick-slip, which this recording does not show."
                          : "None: the model was not fitted, or there are too few cycles to fit.";
    return part(fmt::format("<p class=\"absent\">{}</p>\n", why));
  }
  const FitResult& fit = *analysis.fit;
  const bool is_doubtful = analysis.motion == MotionClass::Undetermined;
  return part((is_doubtful ? "<p>Unreliable: the motion may not be stick-slip.</p>\n" : "") + parameter_table(fit));
}

std::string repeat_part(const Source& source, const ReportOrigin& origin) {
  const Conditions& conditions = source.recording.conditions();
  const Provenance& provenance = source.recording.provenance();
  std::string facts = fact("program", fmt::format("slipfit {}", SLIPFIT_VERSION)) +
                      fact("file", provenance.file.empty() ? "not from a file" : provenance.file) +
                      "<dt>digest of its bytes</dt><dd><code>" +
                      (provenance.input_digest ? provenance.input_digest->text() : "none") + "</code></dd>\n";
  facts += command_fact(origin.command_line);
  facts += fact("driving speed", speed_text(conditions));
  if (conditions.speed_standard_error_m_per_s) {
    facts += fact("its standard error",
                  stated_text(*conditions.speed_standard_error_m_per_s,
                              speed_unit(conditions.speed_unit, conditions.speed_standard_error_m_per_s)));
  }
  facts += fact("normal force",
                conditions.normal_force_N ? stated_text(*conditions.normal_force_N, "N") : std::string("not given"));
  facts += fact("force that the sensor measures", name_of(conditions.force_view));
  facts += fact("sensor's zero",
                conditions.zero_force_N ? stated_text(*conditions.zero_force_N, "N") : std::string("not given"));
  const std::string assumed = list(each(provenance.assumed, text));
  return section(" id=\"repeat\"", "To repeat this",
                 fact_list(facts) + (assumed.empty() ? "" : "<p>Assumed while reading:</p>\n" + assumed));
}

}  // namespace slipfit::html
