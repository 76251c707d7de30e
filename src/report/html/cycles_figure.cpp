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

Figure cycles_figure(const Source& source) {
  Figure figure{"cycles", "Overlaid cycles"};
  figure.guide = std::string(kOverlayGuide) +
                 " A narrow bundle means similar cycles; the spread at the top is the scatter of static friction.";
  if (!shows_cycles(source.analysis)) return figure.without_chart("Steady sliding has no cycles.");
  const OverlaidSet measured{"measured cycles", {{source.recording, source.analysis}}};
  if (!has_cycles(measured)) return figure.without_chart("There are too few slips to overlay cycles.");
  figure.chart = overlay_of(figure.title, {measured}, &source);
  figure.label = fmt::format("{} of {} cycles overlaid, with the fit of a typical one",
                             stack_of(source.analysis, kMostCyclesOfASet).anchors.size(), source.analysis.cycles.count);
  return figure;
}

}  // namespace slipfit::html
