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

std::string quantities_part(const Comparison& comparison) {
  const auto number = [](const EstimateRow& row) { return Cell(text(row.value) + small(row.interval)); };
  std::vector<std::vector<Cell>> rows;
  for (const ComparisonRow& row : comparison_rows(comparison)) {
    rows.push_back({formula_text(row.words) + note(row.note), std::string(row.differs ? "yes" : "not shown"),
                    number(row.a), number(row.b), number(row.difference), number(row.ratio),
                    fmt::format("{}<small>alone: {}</small>", text(row.p_adjusted), text(row.p_value))});
  }
  std::vector<std::string> left_out;
  for (const NotCompared& one : not_compared(comparison))
    left_out.push_back(formula_text(one.words + ": " + one.reason));
  const std::string compared =
      rows.empty()
          ? absent("None.")
          : "<p class=\"guide\">In brackets: 95 % intervals. p: probability of at least this difference if A and B "
            "were equal, for all quantities together (Holm; different below 0.05) and for each quantity alone.</p>\n" +
                table(" class=\"plain-table\"", {"quantity", "differs", "#A", "#B", "#B - A", "#B / A", "#p"}, rows);
  return section(" id=\"quantities\" class=\"flows\"", "What is compared", compared) +
         (left_out.empty() ? "" : section(" id=\"absent\"", "What cannot be compared", list(left_out)));
}

std::string files_of(const Comparison& comparison) {
  std::string facts;
  for (const auto& [side, name] : {std::pair{&comparison.a, 'A'}, std::pair{&comparison.b, 'B'}}) {
    for (const ComparedFit& fit : side->fits) {
      facts += fact(fmt::format("{}: {}", name, fit.id), fit.file.empty() ? "several recordings" : fit.file);
    }
  }
  return facts;
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
              html::repeat_part(" class=\"flows\"", origin.command_line, html::files_of(comparison));
  return html::page_from(page);
}

}  // namespace slipfit
