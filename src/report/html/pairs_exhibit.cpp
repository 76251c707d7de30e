#include <fmt/format.h>

#include "report/html/exhibit.hpp"
#include "report/html/scaling.hpp"

namespace slipfit::html {
namespace {

using chart::Colour, chart::Point, chart::Shape, chart::Stroke;

constexpr std::size_t kMostPairs = 1000;

/// Peak above F_k and trough relative to it, in the unit of the chart; evenly chosen where they are many.
std::vector<Point> pairs_of(const Source& source) {
  std::vector<Point> pairs;
  const double scale = source.force_unit.per_SI;
  for (const Cycle& cycle : source.analysis.cycle_table) {
    if (!cycle.used || !cycle.level_force) continue;
    pairs.push_back(
        {scale * (cycle.peak_force - *cycle.level_force), scale * (cycle.trough_force - *cycle.level_force)});
  }
  if (pairs.size() <= kMostPairs) return pairs;
  std::vector<Point> chosen;
  for (std::size_t i = 0; i < kMostPairs; ++i) chosen.push_back(pairs[i * pairs.size() / kMostPairs]);
  return chosen;
}

chart::Panel pairs_panel(const Source& source, const std::vector<Point>& pairs) {
  const std::string unit = source.force_unit.unit;
  const Estimate& reflection = source.background.reflection;
  Span peaks;
  Span troughs;
  for (const Point& pair : pairs) {
    peaks.add(pair.x);
    troughs.add(pair.y);
  }
  chart::Panel panel;
  panel.legend_at = chart::LegendAt::Above;
  panel.x = peaks.linear_axis(label_with_unit("peak above kinetic friction", unit));
  troughs.add(-*reflection.value * peaks.low());
  troughs.add(-*reflection.value * peaks.high());
  troughs.add(-peaks.high());
  panel.y = troughs.linear_axis(label_with_unit("trough above kinetic friction", unit));
  const double left = panel.x.low;
  const double right = panel.x.high;
  const auto line_to = [left, right](double ratio) {
    return std::vector<Point>{{left, -ratio * left}, {right, -ratio * right}};
  };
  if (reflection.ci95) {
    const double low = reflection.ci95->low;
    const double high = reflection.ci95->high;
    panel.areas.push_back({"95 % interval",
                           Colour::Blue,
                           chart::Fill::Plain,
                           {{left, -low * left}, {right, -low * right}, {right, -high * right}, {left, -high * left}}});
  }
  panel.lines = {{fmt::format("fitted damping, slope -{:.3g}", *reflection.value), Colour::Vermillion, Stroke::Solid,
                  line_to(*reflection.value)},
                 {"no damping, slope -1", Colour::Black, Stroke::Dashed, line_to(1.0), 1.2}};
  panel.markers = {{"cycles", Colour::Grey, Shape::Speck, pairs}};
  return panel;
}

std::string reason_for_none(const Source& source, const std::vector<Point>& pairs) {
  const Estimate& reflection = source.background.reflection;
  if (source.analysis.verdict != Verdict::StickSlip) return "Without stick-slip cycles there are no such pairs.";
  if (source.recording.conditions().force_view == ForceView::Contact) {
    return "A sensor at the contact reads the friction force: its trough does not show how far the spring swings.";
  }
  if (!reflection.value) {
    const std::string why = reflection.note.empty() ? "the fitted model has none" : reflection.note;
    return "The damping ratio is not known: " + why + ".";
  }
  return pairs.size() < 3 ? "There are too few fitted cycles." : "";
}

}  // namespace

Exhibit pairs_exhibit(const Source& source) {
  Exhibit exhibit{"pairs", "Damping from peaks and troughs", {}, {}, {}, {}};
  exhibit.guide =
      "Each point is one slip: how far the force stood above kinetic friction at its peak, and how far it swung below "
      "at its trough. Without damping the trough mirrors the peak (dashed line). Damping makes the swing smaller by "
      "exp(-pi zeta / sqrt(1 - zeta^2)): the points should lie along the solid line.";
  const std::vector<Point> pairs = pairs_of(source);
  exhibit.absent = reason_for_none(source, pairs);
  if (!exhibit.absent.empty()) return exhibit;
  exhibit.chart = chart::Chart{"Peaks and troughs", {}, {pairs_panel(source, pairs)}};
  exhibit.label = fmt::format("trough against peak of {} slips, with the line of the fitted damping, slope -{:.3g}",
                              pairs.size(), *source.background.reflection.value);
  return exhibit;
}

}  // namespace slipfit::html
