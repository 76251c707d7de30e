#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "report/comparison_text.hpp"
#include "report/html/markup.hpp"
#include "report/html/page.hpp"
#include "report/html/scaling.hpp"
#include "report/html/stack.hpp"
#include "slipfit/report/comparison.hpp"

namespace slipfit {
namespace html {
namespace {

using Recordings = std::vector<ComparedRecording>;

/// One side of the chart: colour, name in the legend, recordings.
struct ChartSide {
  chart::Colour colour;
  std::string name;
  const Recordings& recordings;
};

std::vector<CycleWindow> windows_of_side(const Recordings& recordings) {
  for (const ComparedRecording& one : recordings) {
    if (!shows_cycles(one.analysis)) continue;
    auto windows = windows_of(one.analysis.cycles, one.recording.sample_interval_s());
    if (!windows.empty()) return windows;
  }
  return {};
}

/// Cycles of all recordings of a side, about as many of each.
chart::Line cycles_of(const ChartSide& side, const DisplayUnit& force, CycleWindow window) {
  constexpr std::size_t kMostCycles = 24;  // of a side
  constexpr double kWidth_px = 0.7;
  static const Background kNone;
  chart::Line all{side.name, side.colour, chart::Stroke::Solid, {}, kWidth_px};
  const std::size_t each = std::max<std::size_t>(1, kMostCycles / side.recordings.size());
  for (const ComparedRecording& one : side.recordings) {
    if (!shows_cycles(one.analysis)) continue;
    Source source = source_of(one.recording, one.analysis, kNone);
    source.force_unit = force;
    const chart::Line line = laid_cycles(source, stack_of(one.analysis, each), window);
    all.points.insert(all.points.end(), line.points.begin(), line.points.end());
  }
  return all;
}

chart::Panel panel_of_sides(const std::vector<ChartSide>& sides, const DisplayUnit& force, CycleWindow window) {
  const DisplayUnit time = display_unit("s", window.after_s);
  chart::Panel panel;
  panel.height_px = 280.0;
  panel.legend_at = chart::LegendAt::Above;
  Span height;
  for (const ChartSide& side : sides) {
    panel.lines.push_back(cycles_of(side, force, window));
    for (chart::Point& point : panel.lines.back().points) {
      point.x *= time.per_SI;
      height.add(point.y);
    }
  }
  panel.x = {label_with_unit("time since the slip began", time.unit), -window.before_s * time.per_SI,
             window.after_s * time.per_SI, chart::Scale::Linear};
  const Recording& recording = sides.front().recordings.front().recording;
  panel.y = height.linear_axis(label_with_unit(force_name_of(recording) + " above kinetic level", force.unit));
  return panel;
}

Figure both_cycles_figure(const ComparisonOrigin& origin) {
  Figure figure{"cycles", "Cycles of A and B laid over each other"};
  figure.guide = "Every cycle moved so that its slip begins at time zero and its kinetic friction lies at zero force.";
  figure.label = "cycles of A and of B laid over each other";
  const auto windows_a = windows_of_side(origin.recordings_a);
  const auto windows_b = windows_of_side(origin.recordings_b);
  if (windows_a.empty() || windows_b.empty()) {
    figure.absent = "Results of fits hold no traces, and steady sliding has no cycles: name the recordings themselves.";
    return figure;
  }
  const std::vector<ChartSide> sides{{chart::Colour::Blue, "A", origin.recordings_a},
                                     {chart::Colour::Vermillion, "B", origin.recordings_b}};
  const DisplayUnit unit_a = force_unit_of(origin.recordings_a.front().recording);
  const DisplayUnit unit_b = force_unit_of(origin.recordings_b.front().recording);
  const DisplayUnit& force = unit_a.per_SI < unit_b.per_SI ? unit_a : unit_b;
  chart::Chart chart{figure.title, {}, {}};
  for (std::size_t i = 0; i < std::min(windows_a.size(), windows_b.size()); ++i) {
    const CycleWindow window{std::max(windows_a[i].before_s, windows_b[i].before_s),
                             std::max(windows_a[i].after_s, windows_b[i].after_s)};
    chart.panels.push_back(panel_of_sides(sides, force, window));
  }
  if (chart.panels.size() > 1) figure.guide += " Above: whole cycles; below: the slip close up.";
  figure.chart = std::move(chart);
  return figure;
}

std::string number_cell(const EstimateRow& row) {
  const std::string interval = row.interval == "-" ? "" : "<small>" + text(row.interval) + "</small>";
  return "<td class=\"number\">" + text(row.value) + interval + "</td>";
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
          : "<p class=\"guide\">In brackets: 95 % intervals. p: that chance alone shows as much where A and B do "
            "not differ, for all quantities together (Holm; they differ below 0.05), and for each alone.</p>\n" +
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
