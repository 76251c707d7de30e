#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include <limits>
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
  const bool has_fit = shows_cycles(source.analysis) && source.analysis.fit && !source.analysis.fit->curve.empty();
  return filled(assets::trace_part(),
                {{"title", text(exhibit.title)},
                 {"guide", formula_text(exhibit.guide)},
                 {"label", text(exhibit.label)},
                 {"slips_key", shows_cycles(source.analysis) ? "<span class=\"key slips\"></span>slips" : ""},
                 {"fit_key", has_fit ? "<span class=\"key fit\"></span>fit" : ""},
                 {"chart", to_page_svg(*exhibit.chart, {exhibit.id, exhibit.label})}});
}

std::string exhibits_part(const Source& source) {
  std::string parts;
  for (const Exhibit& exhibit : exhibits_of(source)) {
    parts += exhibit.id == "trace" && exhibit.chart ? trace_part(exhibit, source) : exhibit_part(exhibit);
  }
  return parts;
}

std::string reason_of(const Analysis& analysis) {
  std::string reason = formula_text(analysis.verdict_reason);
  if (!reason.empty()) reason.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(reason.front())));
  return reason;
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

namespace {

std::vector<double> fitted_force(const Recording& recording, const Analysis& analysis) {
  std::vector<double> fitted(recording.size(), std::numeric_limits<double>::quiet_NaN());
  if (!analysis.fit) return fitted;
  for (const CurvePoint& point : analysis.fit->curve) {
    if (point.sample < fitted.size()) fitted[point.sample] = point.force;
  }
  return fitted;
}

}  // namespace

Source source_of(const Recording& recording, const Analysis& analysis, const Background& background) {
  return {recording, analysis, background, force_unit_of(recording), fitted_force(recording, analysis)};
}

bool shows_cycles(const Analysis& analysis) {
  return analysis.verdict != Verdict::SteadySliding;
}

std::vector<Exhibit> exhibits_of(const Source& source) {
  return {trace_exhibit(source), spectrum_exhibit(source), cycles_exhibit(source), pairs_exhibit(source),
          map_exhibit(source),   speed_exhibit(source),    pattern_exhibit(source)};
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
  using html::text;
  const html::Source source = html::source_of(recording, analysis, background);
  const std::string& file = recording.provenance().file;
  const std::string library(assets::dygraphs_script());
  return html::filled(assets::recording_page(),
                      {{"title", text(file.empty() ? "recording" : file)},
                       {"library_style", std::string(assets::dygraphs_style())},
                       {"style", std::string(assets::style())},
                       {"verdict", html::verdict_sentence(source)},
                       {"reason", html::reason_of(analysis)},
                       {"key_numbers", html::key_numbers(source)},
                       {"warnings", html::warnings_part(all_warnings(recording, analysis))},
                       {"parameters", html::parameters_part(source)},
                       {"exhibits", html::exhibits_part(source)},
                       {"quality", html::quality_part(source)},
                       {"numbers", html::numbers_part(source)},
                       {"repeat", html::repeat_part(source, origin)},
                       {"footer", fmt::format("Made by slipfit {}{}.", SLIPFIT_VERSION,
                                              library.empty() ? "" : "; interactive trace by dygraphs (MIT licence)")},
                       {"trace_data", library.empty() ? std::string() : html::trace_data(source)},
                       {"library_script", library},
                       {"script", library.empty() ? std::string() : std::string(assets::trace_script())}});
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
