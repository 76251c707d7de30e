#include <fmt/format.h>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "report/html/assets.hpp"
#include "report/html/markup.hpp"
#include "report/html/page.hpp"
#include "report/html/scaling.hpp"
#include "report/json_values.hpp"
#include "report/quantities.hpp"
#include "slipfit/report/text.hpp"

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
  return {trace_figure(source), spectrum_figure(source), cycles_figure(source), evolution_figure(source),
          pairs_figure(source), map_figure(source),      speed_figure(source),  pattern_figure(source)};
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
