#include <fmt/format.h>

#include <array>
#include <optional>
#include <string_view>

#include "report/html/figure.hpp"
#include "report/html/scaling.hpp"

namespace slipfit::html {
namespace {

constexpr std::size_t kMostSlips = 1000;  // evenly chosen where there are more

/// A quantity of a slip, in SI; empty where it is not known. `slip`: place in the table of cycles.
using SlipQuantity = std::optional<double> (*)(const Source& source, std::size_t slip);

double begin_s(const Cycle& cycle) {
  return cycle.onset_s.value_or(cycle.peak_s);
}

/// What is drawn over the number of the slip: one row for each panel.
struct Evolution {
  const char* label;
  const char* SI_unit;  ///< "force": the unit of the force column
  SlipQuantity quantity;
};

constexpr std::array kEvolutions = std::to_array<Evolution>(
    {{"peak force", "force",
      [](const Source& source, std::size_t slip) {
        return std::optional(source.analysis.cycle_table[slip].peak_force);
      }},
     {"force drop", "force",
      [](const Source& source, std::size_t slip) {
        const Cycle& cycle = source.analysis.cycle_table[slip];
        return std::optional(cycle.peak_force - cycle.trough_force);
      }},
     {"period", "s", [](const Source& source, std::size_t slip) {
        const std::vector<Cycle>& cycles = source.analysis.cycle_table;
        return slip == 0 ? std::nullopt : std::optional(begin_s(cycles[slip]) - begin_s(cycles[slip - 1]));
      }}});

chart::Panel panel_of(const Source& source, const Evolution& evolution) {
  const std::size_t slips = source.analysis.cycle_table.size();
  const std::size_t step = slips / kMostSlips + 1;
  chart::Line line{"", chart::Colour::Blue, chart::Stroke::Solid, {}, 1.2};
  for (std::size_t i = 0; i < slips; i += step) {
    if (const auto value = evolution.quantity(source, i)) line.points.push_back({static_cast<double>(i + 1), *value});
  }
  const bool is_force = std::string_view(evolution.SI_unit) == "force";
  const DisplayUnit unit =
      is_force ? source.force_unit : display_unit(evolution.SI_unit, source.analysis.cycles.period_s);
  Span span;
  for (chart::Point& point : line.points) span.add(point.y *= unit.per_SI);
  chart::Panel panel;
  panel.height_px = 110.0;
  panel.x = {"number of the slip", 0.5, static_cast<double>(slips) + 0.5};
  panel.y = span.linear_axis(label_with_unit(evolution.label, unit.unit));
  panel.lines.push_back(std::move(line));
  return panel;
}

}  // namespace

Figure evolution_figure(const Source& source) {
  Figure figure{
      "evolution", "Evolution over the slips",
      "Peak force, force drop and period of each slip, in their order. A trend is wear, warming or a drift of "
      "the sensor; a step is a change of the contact; a long time may be a slip that was missed."};
  constexpr std::size_t kFewestSlips = 5;
  if (!shows_cycles(source.analysis) || source.analysis.cycle_table.size() < kFewestSlips)
    return figure.without_chart("There are too few slips to show how they change.");
  chart::Chart chart{"Evolution over the slips", {}, {}};
  for (const Evolution& evolution : kEvolutions) chart.panels.push_back(panel_of(source, evolution));
  figure.chart = std::move(chart);
  figure.label = fmt::format("peak force, force drop and period of {} slips", source.analysis.cycle_table.size());
  return figure;
}

}  // namespace slipfit::html
