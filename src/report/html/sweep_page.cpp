#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "report/html/assets.hpp"
#include "report/html/markup.hpp"
#include "report/html/page.hpp"
#include "report/html/scaling.hpp"
#include "report/html/sweep_exhibits.hpp"
#include "report/names.hpp"
#include "report/text_sections.hpp"
#include "slipfit/report/sweep_html.hpp"

namespace slipfit {
namespace html {
namespace {

std::string verdict_of(const SweepSource& source) {
  if (!source.sweep.joint) return fmt::format("{} recordings, no joint fit.", source.entries.size());
  const Estimate& critical = source.sweep.derived.critical_speed_m_per_s;
  const std::string end = critical.value ? fmt::format(": stick-slip ends at {}", quantity_of(critical, "m/s"))
                                         : std::string(": where stick-slip ends is not known");
  const auto left_out = std::count(source.sweep.roles.begin(), source.sweep.roles.end(), SweepRole::LeftOut);
  const auto fitted = static_cast<std::ptrdiff_t>(source.entries.size()) - left_out;
  return text(fmt::format("{} recordings, {} fitted together{}.", source.entries.size(), fitted, end));
}

std::string parameters_of(const SweepAnalysis& sweep) {
  std::string part = "<section id=\"parameters\">\n<h2>Parameters of all recordings</h2>\n";
  if (!sweep.joint) return part + "<p class=\"absent\">" + formula_text(sweep.joint_reason) + "</p>\n</section>\n";
  return part + parameter_table(sweep.joint->fit) + "</section>\n";
}

std::string estimate_cell(const Estimate& estimate, const std::string& SI_unit) {
  const EstimateRow row = estimate_row(estimate, SI_unit);
  const std::string interval = row.interval == "-" ? "" : "<small>" + text(row.interval) + "</small>";
  return fmt::format("<td class=\"number\">{} {}{}</td>", text(row.value), text(row.value == "-" ? "" : row.unit),
                     interval);
}

std::string off_by(const Estimate& predicted, const Estimate& measured) {
  if (!predicted.value || !measured.value) return "-";
  return fmt::format("{:+.1f} %", 100.0 * (*predicted.value / *measured.value - 1.0));
}

std::string recordings_of(const SweepSource& source) {
  std::string rows;
  for (std::size_t i = 0; i < source.entries.size(); ++i) {
    const Analysis& analysis = source.sweep.recordings[i];
    const Estimate& measured = analysis.derived.pattern_spacing_m;
    const Estimate predicted = source.sweep.joint ? source.sweep.joint->points[i].spacing_left_out_m : Estimate{};
    std::string shows(name_of(analysis.verdict));
    std::replace(shows.begin(), shows.end(), '_', '-');
    if (source.sweep.roles[i] == SweepRole::LeftOut) shows += ", left out";
    rows += fmt::format(
        "<tr><th scope=\"row\">{}</th><td class=\"number\">{}</td><td>{}</td>{}{}<td class=\"number\">{}"
        "</td></tr>\n",
        text(source.entries[i].id), text(stated_text(source.entries[i].recording.conditions().speed_m_per_s, "m/s")),
        text(shows), estimate_cell(measured, "m"), estimate_cell(predicted, "m"), text(off_by(predicted, measured)));
  }
  return "<section class=\"flows\">\n<h2>Each recording, predicted without it</h2>\n<div class=\"wide\"><table "
         "class=\"plain-table\"><thead><tr><th scope=\"col\">recording</th><th scope=\"col\" "
         "class=\"number\">speed</th><th scope=\"col\">shows</th><th scope=\"col\" class=\"number\">spacing measured "
         "(V/f)</th><th scope=\"col\" class=\"number\">predicted without it</th><th scope=\"col\" class=\"number\">off "
         "by</th></tr></thead><tbody>\n" +
         rows + "</tbody></table></div>\n</section>\n";
}

std::string repeat_of(const SweepSource& source, const SweepOrigin& origin) {
  std::string facts = fact("program", fmt::format("slipfit {}", SLIPFIT_VERSION));
  if (!origin.command_line.empty()) {
    facts += "<dt>command</dt><dd><code>" + text(origin.command_line) + "</code></dd>\n";
  }
  for (std::size_t i = 0; i < source.entries.size(); ++i) {
    const bool has_hash = i < origin.file_sha256.size() && origin.file_sha256[i];
    facts += fmt::format("<dt>{}</dt><dd>{}<br><code>{}</code></dd>\n", text(source.entries[i].id),
                         text(source.entries[i].recording.provenance().file),
                         has_hash ? "SHA-256 " + text(*origin.file_sha256[i]) : "SHA-256 not known");
  }
  return "<section id=\"repeat\" class=\"flows\">\n<h2>To repeat this</h2>\n<dl class=\"facts\">\n" + facts +
         "</dl>\n</section>\n";
}

}  // namespace
}  // namespace html

std::string to_html(std::span<const SweepEntry> entries, const SweepAnalysis& sweep, const SweepOrigin& origin) {
  const html::SweepSource source{entries, sweep};
  const std::string exhibits = html::exhibit_part(html::sweep_spacing_exhibit(source)) +
                               html::exhibit_part(html::sweep_friction_exhibit(source)) + html::recordings_of(source) +
                               html::exhibit_part(html::sweep_traces_exhibit(source));
  return html::filled(assets::sweep_page(), {{"title", html::text(origin.name)},
                                             {"style", std::string(assets::style())},
                                             {"verdict", html::verdict_of(source)},
                                             {"reason", html::formula_text(sweep.joint_reason)},
                                             {"warnings", html::warnings_part(all_warnings(sweep))},
                                             {"parameters", html::parameters_of(sweep)},
                                             {"exhibits", exhibits},
                                             {"repeat", html::repeat_of(source, origin)},
                                             {"footer", fmt::format("Made by slipfit {}.", SLIPFIT_VERSION)}});
}

}  // namespace slipfit
