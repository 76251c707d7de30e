#include <fmt/format.h>

#include <string>
#include <vector>

#include "report/comparison_rows.hpp"
#include "report/html/figure.hpp"
#include "report/html/page.hpp"
#include "slipfit/report/comparison.hpp"

namespace slipfit {
namespace html {
namespace {

OverlaidSet side_of(const std::string& name, const std::vector<ComparedRecording>& recordings) {
  OverlaidSet set{name, {}};
  for (const ComparedRecording& one : recordings) set.recordings.push_back({one.recording, one.analysis});
  return set;
}

Figure both_cycles_figure(const ComparisonOrigin& origin) {
  Figure figure{"cycles", "Overlaid cycles of A and B"};
  figure.guide = std::string(kOverlayGuide);
  figure.label = "overlaid cycles of A and of B";
  const std::vector<OverlaidSet> sides{side_of("A", origin.recordings_a), side_of("B", origin.recordings_b)};
  if (has_cycles(sides.front()) && has_cycles(sides.back())) {
    figure.chart = overlay_of(figure.title, sides);
  } else {
    figure.absent =
        "Results of fits contain no traces, and steady sliding has no cycles: give the recordings themselves.";
  }
  return figure;
}

std::string number_cell(const EstimateRow& row) {
  return "<td class=\"number\">" + text(row.value) + small(row.interval) + "</td>";
}

std::string table_row(const ComparisonRow& row) {
  const std::string note = row.note.empty() ? "" : "<span class=\"note\">" + formula_text(row.note) + "</span>";
  return fmt::format("<tr><td>{}{}</td><td>{}</td>{}{}{}{}<td class=\"number\">{}<small>alone: {}</small></td></tr>\n",
                     formula_text(row.words), note, row.differs ? "yes" : "not shown", number_cell(row.a),
                     number_cell(row.b), number_cell(row.difference), number_cell(row.ratio), text(row.p_adjusted),
                     text(row.p_value));
}

std::string quantities_part(const Comparison& comparison) {
  std::string rows;
  for (const ComparisonRow& row : comparison_rows(comparison)) rows += table_row(row);
  std::vector<std::string> absent;
  for (const NotCompared& one : not_compared(comparison)) absent.push_back(formula_text(one.words + ": " + one.reason));
  const std::string compared =
      rows.empty()
          ? "<p class=\"absent\">None.</p>\n"
          : "<p class=\"guide\">In brackets: 95 % intervals. p: probability of at least this difference if A and B "
            "were equal, for all quantities together (Holm; different below 0.05) and for each quantity alone.</p>\n" +
                table(" class=\"plain-table\"", {"quantity", "differs", "#A", "#B", "#B - A", "#B / A", "#p"}, rows);
  return section(" id=\"quantities\" class=\"flows\"", "What is compared", compared) +
         (absent.empty() ? "" : section(" id=\"absent\"", "What cannot be compared", list(absent)));
}

std::string recordings_part(const Comparison& comparison, const ComparisonOrigin& origin) {
  std::string facts = fact("program", fmt::format("slipfit {}", SLIPFIT_VERSION)) + command_fact(origin.command_line);
  for (const auto& [side, name] : {std::pair{&comparison.a, 'A'}, std::pair{&comparison.b, 'B'}}) {
    for (const ComparedFit& fit : side->fits) {
      facts += fact(fmt::format("{}: {}", name, fit.id), fit.file.empty() ? "several recordings" : fit.file);
    }
  }
  return section(" id=\"repeat\" class=\"flows\"", "To repeat this", fact_list(facts));
}

}  // namespace
}  // namespace html

std::string to_html(const Comparison& comparison, const ComparisonOrigin& origin) {
  html::PageParts page;
  page.title = comparison.a.name + " and " + comparison.b.name;
  page.kind = "comparison";
  page.headline = html::formula_text(comparison_sentence(comparison));
  page.summary = html::fact_list(html::fact("A", side_text(comparison.a)) + html::fact("B", side_text(comparison.b))) +
                 html::warnings_part(comparison.warnings);
  page.main = html::quantities_part(comparison) + html::figure_part(html::both_cycles_figure(origin)) +
              html::recordings_part(comparison, origin);
  return html::page_from(page);
}

}  // namespace slipfit
