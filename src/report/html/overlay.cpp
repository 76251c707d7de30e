// Cycles on top of each other: of a recording with its fit, of the recordings of a sweep, of the sides of a comparison.

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "report/html/figure.hpp"
#include "report/html/speed_figures.hpp"
#include "report/quantity_rows.hpp"

namespace slipfit::html {
namespace {

using chart::Colour, chart::Point, chart::Stroke;

constexpr std::size_t kMostCycles = 48;  // of all sets
constexpr std::size_t kMostCyclesOfASet = 24;

/// The quantities of a panel.
struct OverlayAxis {
  bool is_close_up;  ///< the slip alone
  const char* label;
  const char* unit;
  double (*per_second)(const Recording&);
  chart::LegendAt legend_at;
};

constexpr std::array kAxes = std::to_array<OverlayAxis>(
    {{false, "path of the drive since the slip began", "m",
      [](const Recording& recording) { return recording.conditions().speed_m_per_s; }, chart::LegendAt::Above},
     {true, "time since the slip began", "s", [](const Recording&) { return 1.0; }, chart::LegendAt::None}});

/// A part of a cycle around the start of its slip, in s or in the SI unit of an axis.
struct CycleWindow {
  double before = 0.0;
  double after = 0.0;
};

/// The reference point of a cycle: the onset and F_k by the fit, otherwise the turning points.
struct Anchor {
  double time_s = 0.0;
  double force = 0.0;
  double height = 0.0;  ///< of the peak above it
};

/// Returns the anchors of the fitted cycles, otherwise of all.
std::vector<Anchor> anchors_of(const Analysis& analysis) {
  std::vector<Anchor> anchors;
  for (const Cycle& cycle : analysis.cycle_table) {
    if (analysis.cycles.used > 0 && !(cycle.used && cycle.level_force)) continue;
    const double force = cycle.level_force.value_or(cycle.trough_force);
    anchors.push_back({slip_begin_s(cycle), force, cycle.onset_force.value_or(cycle.peak_force) - force});
  }
  return anchors;
}

/// Returns the window of a recording in s, or nothing if it has no cycles or too few samples in it.
std::optional<CycleWindow> window_of(const OverlaidRecording& one, const OverlayAxis& axis) {
  const CycleStatistics& cycles = one.analysis.cycles;
  if (!shows_cycles(one.analysis) || !cycles.period_s || anchors_of(one.analysis).empty()) return std::nullopt;
  const CycleWindow whole{0.3 * *cycles.period_s, 0.8 * *cycles.period_s};
  if (!axis.is_close_up) return whole;
  const double slip_s = cycles.slip_time_s.value_or(0.0);
  const CycleWindow slip{slip_s, 2.5 * slip_s};
  const bool is_resolved = slip_s > 2.0 * one.recording.sample_interval_s();
  return is_resolved && slip.after < whole.after ? std::optional(slip) : std::nullopt;
}

/// Colours in the order of the sets; further rounds in other strokes.
chart::Line line_of(const OverlaidSet& set, std::size_t number) {
  constexpr std::array kColours{Colour::Blue,   Colour::Vermillion, Colour::Green, Colour::Purple,
                                Colour::Orange, Colour::SkyBlue,    Colour::Black, Colour::Yellow};
  constexpr std::array kStrokes{Stroke::Solid, Stroke::Dashed};
  return {set.name,
          kColours.at(number % kColours.size()),
          kStrokes.at(number / kColours.size() % kStrokes.size()),
          {},
          1.0};
}

/// A panel of the overlay with the units of its axes, which suit the largest force and the widest window of all.
struct OverlayPanel {
  OverlayPanel(const OverlayAxis& of, const std::vector<OverlaidSet>& sets) : axis(of) {
    force = force_unit_of(sets.front().recordings.front().recording);
    for (const OverlaidSet& set : sets) {
      for (const OverlaidRecording& one : set.recordings) {
        const DisplayUnit unit = force_unit_of(one.recording);
        if (unit.per_SI < force.per_SI) force = unit;
        const CycleWindow window = window_of(one, axis).value_or(CycleWindow{});
        const double scale = axis.per_second(one.recording);
        reach = {std::max(reach.before, scale * window.before), std::max(reach.after, scale * window.after)};
      }
    }
    path = display_unit(axis.unit, reach.after);
  }

  /// Adds one cycle of a force, shifted to its anchor.
  void add_cycle(const Recording& recording, std::span<const double> cycle, const Anchor& anchor,
                 chart::Line& line) const {
    constexpr std::size_t kPointsOfCycle = 80;
    const double per_second = axis.per_second(recording);
    const SampleRange range =
        samples_between(recording, anchor.time_s - reach.before / per_second, anchor.time_s + reach.after / per_second);
    for (const Point& point : envelope(range.of(recording.time_s()), range.of(cycle), kPointsOfCycle)) {
      line.points.push_back(
          {path.per_SI * per_second * (point.x - anchor.time_s), force.per_SI * (point.y - anchor.force)});
    }
  }

  void add_set(const OverlaidSet& set, std::size_t most_cycles, chart::Line line) {
    const std::size_t each = std::max<std::size_t>(1, most_cycles / std::max<std::size_t>(1, set.recordings.size()));
    for (const auto& [recording, analysis] : set.recordings) {
      if (!window_of({recording, analysis}, axis)) continue;
      on_kinetic_level = on_kinetic_level && analysis.cycles.used > 0;
      const std::vector<double> slips = force_without_interference(recording, analysis);
      for (const Anchor& anchor : evenly_chosen(anchors_of(analysis), each)) {
        add_cycle(recording, slips, anchor, line);
        line.points.push_back({0.0, std::numeric_limits<double>::quiet_NaN()});
      }
    }
    height.add(line.points);
    panel.lines.push_back(std::move(line));
  }

  /// Adds the fit without the interference, whose phase differs from cycle to cycle, around a cycle of median height.
  void add_fit(const Source& source) {
    std::vector<double> fit = source.fitted;
    for (std::size_t i = 0; i < fit.size(); ++i) fit[i] -= source.recording.force()[i] - source.force_of_slips[i];
    std::vector<Anchor> all = anchors_of(source.analysis);
    const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    std::nth_element(all.begin(), middle, all.end(),
                     [](const Anchor& a, const Anchor& b) { return a.height < b.height; });
    chart::Line line{"fit of a typical cycle", Colour::Vermillion, Stroke::Solid, {}, 2.4};
    add_cycle(source.recording, fit, *middle, line);
    if (std::ranges::any_of(line.points, [](const Point& p) { return std::isfinite(p.y); })) {
      panel.lines.push_back(std::move(line));
    }
  }

  const OverlayAxis& axis;
  CycleWindow reach;  ///< of the widest window, in the SI unit of the axis
  DisplayUnit path;
  DisplayUnit force;
  chart::Panel panel;
  Span height;
  bool on_kinetic_level = true;
};

}  // namespace

bool has_cycles(const OverlaidSet& set) {
  return std::ranges::any_of(set.recordings,
                             [](const OverlaidRecording& one) { return window_of(one, kAxes.front()).has_value(); });
}

chart::Chart overlay_of(const std::string& title, const std::vector<OverlaidSet>& sets, const Source* fitted) {
  const std::size_t most_cycles = std::clamp<std::size_t>(kMostCycles / sets.size(), 2, kMostCyclesOfASet);
  const std::string force_name = force_name_of(sets.front().recordings.front().recording);
  chart::Chart chart{title, {}, {}};
  for (const OverlayAxis& axis : kAxes) {
    OverlayPanel overlay(axis, sets);
    if (overlay.reach.after == 0.0) continue;
    for (std::size_t i = 0; i < sets.size(); ++i) {
      overlay.add_set(
          sets[i], most_cycles,
          fitted != nullptr ? chart::Line{sets[i].name, Colour::Grey, Stroke::Solid, {}, 0.6} : line_of(sets[i], i));
    }
    if (fitted != nullptr) overlay.add_fit(*fitted);
    chart::Panel panel = std::move(overlay.panel);
    panel.height_px = 280.0;
    panel.legend_at = axis.legend_at;
    panel.x = {label_with_unit(axis.label, overlay.path.unit), -overlay.path.per_SI * overlay.reach.before,
               overlay.path.per_SI * overlay.reach.after};
    const char* const level = overlay.on_kinetic_level ? " above kinetic level" : " above kinetic level, or trough";
    panel.y = overlay.height.linear_axis(label_with_unit(force_name + level, overlay.force.unit));
    chart.panels.push_back(std::move(panel));
  }
  return chart;
}

Figure cycles_figure(const Source& source) {
  Figure figure{"cycles", "Overlaid cycles"};
  figure.guide = std::string(kOverlayGuide) +
                 " A narrow bundle means similar cycles; the spread at the top is the scatter of static friction.";
  if (!shows_cycles(source.analysis)) return figure.without_chart("Steady sliding has no cycles.");
  const OverlaidSet measured{"measured cycles", {{source.recording, source.analysis}}};
  if (!has_cycles(measured)) return figure.without_chart("There are too few slips to overlay cycles.");
  figure.chart = overlay_of(figure.title, {measured}, &source);
  figure.label =
      fmt::format("{} of {} cycles overlaid, with the fit of a typical one",
                  std::min(kMostCyclesOfASet, anchors_of(source.analysis).size()), source.analysis.cycles.count);
  return figure;
}

Figure sweep_cycles_figure(const SweepSource& source) {
  constexpr std::size_t kMostTogether = 16;  // colours and strokes that can be distinguished
  Figure figure{"sweep-cycles", "Overlaid cycles of the recordings", std::string(kOverlayGuide)};
  std::vector<OverlaidSet> all;  // with stick-slip, from the slowest to the fastest
  for (const std::size_t i : by_speed(source)) {
    if (source.sweep.recordings[i].motion != MotionClass::StickSlip) continue;
    const SweepEntry& entry = source.entries[i];
    OverlaidSet set{fmt::format("{}, {}", entry.id, speed_text(entry.recording.conditions())),
                    {{entry.recording, source.sweep.recordings[i]}}};
    if (has_cycles(set)) all.push_back(std::move(set));
  }
  if (all.size() < 2) return figure.without_chart("Fewer than two recordings have cycles to overlay.");
  const std::vector<OverlaidSet> shown = evenly_chosen(all, kMostTogether);
  if (shown.size() < all.size())
    figure.guide += fmt::format(" {} of {} recordings are drawn.", shown.size(), all.size());
  figure.label = fmt::format("overlaid cycles of {} recordings, from the slowest to the fastest", shown.size());
  figure.chart = overlay_of(figure.title, shown);
  return figure;
}

}  // namespace slipfit::html
