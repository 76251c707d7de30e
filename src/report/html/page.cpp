#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "report/html/assets.hpp"
#include "report/html/markup.hpp"
#include "report/html/page.hpp"
#include "report/html/scaling.hpp"
#include "report/html/trace_data.hpp"
#include "report/names.hpp"
#include "slipfit/report/text.hpp"

namespace slipfit {
namespace html {
namespace {

/// The chart, and the interactive trace that the script shows in its place where it can.
std::string trace_part(const Exhibit& exhibit, const Source& source) {
  return filled(assets::trace_part(),
                {{"title", text(exhibit.title)},
                 {"guide", formula_text(exhibit.guide)},
                 {"label", text(exhibit.label)},
                 {"slips_key", shows_cycles(source.analysis) ? "<span class=\"key slips\"></span>slips" : ""},
                 {"fit_key", has_fitted_curve(source.analysis) ? "<span class=\"key fit\"></span>fit" : ""},
                 {"chart", to_page_svg(*exhibit.chart, {exhibit.id, exhibit.label})}});
}

/// Charts in their order; what the recording does not allow stands behind them, in a few lines.
std::string exhibits_part(const Source& source) {
  std::string parts;
  std::string absent;
  for (const Exhibit& exhibit : exhibits_of(source)) {
    if (!exhibit.chart) {
      absent += "<dt>" + text(exhibit.title) + "</dt><dd>" + formula_text(exhibit.absent) + "</dd>\n";
      continue;
    }
    parts += exhibit.id == "trace" ? trace_part(exhibit, source) : exhibit_part(exhibit);
  }
  if (absent.empty()) return parts;
  return parts + "<section id=\"absent\">\n<h2>What this recording cannot show</h2>\n<dl class=\"facts\">\n" + absent +
         "</dl>\n</section>\n";
}

std::string numbers_part(const Source& source) {
  std::string numbers = to_text(source.recording, source.analysis);
  std::string lines;
  while (!numbers.empty()) {
    const std::size_t end = std::min(numbers.find('\n'), numbers.size() - 1);
    lines += text(std::string_view(numbers).substr(0, end)) + "\n";
    numbers.erase(0, end + 1);
  }
  return "<section class=\"flows\" id=\"numbers\">\n<h2>All numbers</h2>\n<details><summary>The text report, as "
         "printed by the "
         "command line</summary>\n<pre>" +
         lines + "</pre></details>\n</section>\n";
}

}  // namespace

std::string page_from(const PageParts& parts) {
  return filled(assets::page(), {{"title", text(parts.title)},
                                 {"style", parts.library_style + std::string(assets::style())},
                                 {"kind", parts.kind},
                                 {"headline", parts.headline},
                                 {"summary", parts.summary},
                                 {"main", parts.main},
                                 {"version", SLIPFIT_VERSION},
                                 {"credits", text(parts.credits)},
                                 {"scripts", parts.scripts}});
}

std::string script_element(std::string_view script) {
  return "<script>" + std::string(script) + "</script>\n";
}

std::string exhibit_part(const Exhibit& exhibit) {
  std::string part = fmt::format("<section id=\"{}-section\">\n<h2>{}</h2>\n", exhibit.id, text(exhibit.title));
  if (!exhibit.chart)
    return part + fmt::format("<p class=\"absent\">{}</p>\n</section>\n", formula_text(exhibit.absent));
  return part + fmt::format("<p class=\"guide\">{}</p>\n<figure>{}</figure>\n</section>\n", formula_text(exhibit.guide),
                            to_page_svg(*exhibit.chart, {exhibit.id, exhibit.label}));
}

}  // namespace html

bool has_interactive_trace() {
  return !assets::dygraphs_script().empty();
}

std::string to_html(const Recording& recording, const Analysis& analysis, const Background& background,
                    const ReportOrigin& origin) {
  const html::Source source = html::source_of(recording, analysis, background);
  const std::string& file = recording.provenance().file;
  html::PageParts page;
  page.title = file.empty() ? "recording" : file;
  page.kind = "recording";
  page.headline = html::verdict_sentence(source);
  page.summary = "<p class=\"reason\">" + html::capitalised(html::formula_text(analysis.verdict_reason)) + "</p>\n" +
                 html::key_numbers(source) + html::warnings_part(analysis.warnings);
  page.main = html::parameters_part(source) + html::exhibits_part(source) + html::quality_part(source) +
              html::numbers_part(source) + html::repeat_part(source, origin);
  if (has_interactive_trace()) {
    page.library_style = assets::dygraphs_style();
    page.credits = "; interactive trace by dygraphs (MIT licence)";
    page.scripts = R"(<script type="application/json" id="trace-data">)" + html::trace_data(source) + "</script>\n" +
                   html::script_element(assets::dygraphs_script()) + html::script_element(assets::trace_script());
  }
  return html::page_from(page);
}

std::vector<PictureFile> report_pictures(const Recording& recording, const Analysis& analysis,
                                         const Background& background) {
  std::vector<PictureFile> files;
  for (const html::Exhibit& exhibit : html::exhibits_of(html::source_of(recording, analysis, background))) {
    if (exhibit.chart) files.push_back({exhibit.id + ".svg", to_svg(*exhibit.chart)});
  }
  return files;
}

}  // namespace slipfit
