#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/html/figure.hpp"
#include "report/html/scaling.hpp"
#include "report/html/stack.hpp"

namespace slipfit::html {
namespace {

using chart::Colour, chart::Panel, chart::Point, chart::Stroke;

constexpr std::size_t kCycleColumns = 80;  // of one cycle
Anchor anchor_of(const Cycle& cycle) {
  const double force = cycle.level_force.value_or(cycle.trough_force);
  return {cycle.onset_s.value_or(cycle.peak_s), force, cycle.onset_force.value_or(cycle.peak_force) - force};
}

}  // namespace

Stack stack_of(const Analysis& analysis, std::size_t most_cycles) {
  Stack stack;
  std::vector<Anchor> all;
  const bool is_fitted = analysis.cycles.used > 0;
  for (const Cycle& cycle : analysis.cycle_table) {
    if (!is_fitted || (cycle.used && cycle.level_force)) all.push_back(anchor_of(cycle));
  }
  if (all.empty()) return stack;
  stack.on_kinetic_level = is_fitted;
  const std::size_t count = std::min(most_cycles, all.size());
  for (std::size_t i = 0; i < count; ++i) stack.anchors.push_back(all[i * all.size() / count]);
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
  std::nth_element(all.begin(), middle, all.end(),
                   [](const Anchor& a, const Anchor& b) { return a.height < b.height; });
  stack.typical = *middle;
  return stack;
}

std::vector<Point> laid(const Source& source, std::span<const double> force, const Anchor& anchor, CycleWindow window) {
  const SampleRange range =
      samples_between(source.recording, anchor.time_s - window.before_s, anchor.time_s + window.after_s);
  const double scale = source.force_unit.per_SI;
  std::vector<Point> points = envelope(range.of(source.recording.time_s()), range.of(force), kCycleColumns);
  for (Point& point : points) point = {point.x - anchor.time_s, scale * (point.y - anchor.force)};
  return points;
}

std::vector<CycleWindow> windows_of(const CycleStatistics& cycles, double sample_interval_s) {
  constexpr double kBefore = 0.3;      // periods before the slip
  constexpr double kAfter = 0.8;       // periods after it
  constexpr double kSlipBefore = 1.0;  // slip times, close up
  constexpr double kSlipAfter = 2.5;
  if (!cycles.period_s) return {};
  std::vector<CycleWindow> windows{{kBefore * *cycles.period_s, kAfter * *cycles.period_s}};
  const double slip_s = cycles.slip_time_s.value_or(0.0);
  const bool is_resolved = slip_s > 2.0 * sample_interval_s;
  if (is_resolved && kSlipAfter * slip_s < windows.front().after_s) {
    windows.push_back({kSlipBefore * slip_s, kSlipAfter * slip_s});
  }
  return windows;
}

chart::Line laid_cycles(const Source& source, const Stack& stack, CycleWindow window) {
  chart::Line line{"", Colour::Grey, Stroke::Solid, {}, 0.6};
  for (const Anchor& anchor : stack.anchors) {
    const std::vector<Point> points = laid(source, source.force_of_slips, anchor, window);
    line.points.insert(line.points.end(), points.begin(), points.end());
    line.points.push_back({0.0, std::numeric_limits<double>::quiet_NaN()});
  }
  return line;
}

namespace {

/// The fit at every sample without the interference, whose phase differs from cycle to cycle.
std::vector<double> fit_of_slips(const Source& source) {
  std::vector<double> fit = source.fitted;
  for (std::size_t i = 0; i < fit.size(); ++i) fit[i] -= source.recording.force()[i] - source.force_of_slips[i];
  return fit;
}

Panel panel_of(const Source& source, const Stack& stack, CycleWindow window) {
  chart::Line measured = laid_cycles(source, stack, window);
  measured.name = "measured cycles";
  Span height;
  for (const Point& point : measured.points) height.add(point.y);
  const DisplayUnit unit = display_unit("s", window.after_s);
  chart::Line model{"fit of a typical cycle", Colour::Vermillion, Stroke::Solid,
                    laid(source, fit_of_slips(source), stack.typical, window), 2.4};
  const bool has_model = std::ranges::any_of(model.points, [](const Point& p) { return std::isfinite(p.y); });
  Panel panel;
  panel.height_px = 240.0;
  panel.lines.push_back(std::move(measured));
  if (has_model) panel.lines.push_back(std::move(model));
  for (chart::Line& line : panel.lines) {
    for (Point& point : line.points) point.x *= unit.per_SI;
  }
  panel.x = {label_with_unit("time since the slip began", unit.unit), -window.before_s * unit.per_SI,
             window.after_s * unit.per_SI};
  const char* above = stack.on_kinetic_level ? " above kinetic level" : " above trough";
  panel.y = height.linear_axis(label_with_unit(force_name_of(source.recording) + above, source.force_unit.unit));
  return panel;
}

}  // namespace

Figure cycles_figure(const Source& source) {
  Figure figure{"cycles", "Overlaid cycles"};
  figure.guide =
      "All cycles, shifted so that the slip starts at time zero and the kinetic friction is at zero force. A narrow "
      "bundle means similar cycles; the spread at the top is the scatter of static friction. Top: whole cycles; "
      "bottom: the slip enlarged, whose shape determines natural frequency and damping.";
  if (!shows_cycles(source.analysis)) return figure.without_chart("Steady sliding has no cycles.");
  constexpr std::size_t kMostCycles = 30;
  const Stack stack = stack_of(source.analysis, kMostCycles);
  const CycleStatistics& cycles = source.analysis.cycles;
  const auto windows = windows_of(cycles, source.recording.sample_interval_s());
  if (stack.anchors.empty() || windows.empty())
    return figure.without_chart("There are too few slips to overlay cycles.");
  chart::Chart chart{"Overlaid cycles", {}, {}};
  for (const CycleWindow& window : windows) chart.panels.push_back(panel_of(source, stack, window));
  figure.chart = std::move(chart);
  figure.label =
      fmt::format("{} of {} cycles overlaid, with the fit of a typical one", stack.anchors.size(), cycles.count);
  return figure;
}

}  // namespace slipfit::html
