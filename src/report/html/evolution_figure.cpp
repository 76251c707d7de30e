#include <fmt/format.h>

#include <limits>
#include <string>
#include <vector>

#include "report/html/figure.hpp"
#include "report/html/scaling.hpp"

namespace slipfit::html {
namespace {

/// A value in SI for each slip; not finite where it is not known. Evenly chosen where they are many.
chart::Panel panel_over_slips(const std::string& name, const DisplayUnit& unit, const std::vector<double>& values) {
  constexpr std::size_t kMostSlips = 1000;
  chart::Line line{"", chart::Colour::Blue, chart::Stroke::Solid, {}, 1.2};
  Span span;
  for (std::size_t i = 0; i < values.size(); i += values.size() / kMostSlips + 1) {
    line.points.push_back({static_cast<double>(i + 1), unit.per_SI * values[i]});
    span.add(line.points.back().y);
  }
  chart::Panel panel;
  panel.height_px = 110.0;
  panel.x = {"number of the slip", 0.5, static_cast<double>(values.size()) + 0.5};
  panel.y = span.linear_axis(label_with_unit(name, unit.unit));
  panel.lines.push_back(std::move(line));
  return panel;
}

}  // namespace

Figure evolution_figure(const Source& source) {
  Figure figure{
      "evolution", "Evolution over the slips",
      "Peak force, force drop and period of each slip in order. A trend indicates wear, heating or drift of the "
      "sensor; a step indicates a change of the contact; a long period may be a slip that was not detected."};
  constexpr std::size_t kFewestSlips = 5;
  const std::vector<Cycle>& cycles = source.analysis.cycle_table;
  if (!shows_cycles(source.analysis) || cycles.size() < kFewestSlips)
    return figure.without_chart("There are too few slips to show how they change.");
  std::vector<double> peaks, drops, periods_s;
  double before_s = std::numeric_limits<double>::quiet_NaN();
  for (const Cycle& cycle : cycles) {
    const double begin_s = cycle.onset_s.value_or(cycle.peak_s);
    peaks.push_back(cycle.peak_force);
    drops.push_back(cycle.peak_force - cycle.trough_force);
    periods_s.push_back(begin_s - before_s);
    before_s = begin_s;
  }
  figure.chart =
      chart::Chart{figure.title,
                   {},
                   {panel_over_slips("peak force", source.force_unit, peaks),
                    panel_over_slips("force drop", source.force_unit, drops),
                    panel_over_slips("period", display_unit("s", source.analysis.cycles.period_s), periods_s)}};
  figure.label = fmt::format("peak force, force drop and period of {} slips", cycles.size());
  return figure;
}

}  // namespace slipfit::html
