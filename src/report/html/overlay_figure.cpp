#include "report/html/figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "report/html/scaling.hpp"
#include "report/html/stack.hpp"
#include "report/html/sweep_figures.hpp"
#include "report/quantities.hpp"

namespace slipfit::html {
namespace {

using chart::Colour, chart::Stroke;

/// The quantities of a panel.
struct OverlayAxis {
  std::size_t window;  ///< of `windows_of`
  const char* label;
  const char* unit;
  double (*per_second)(const Recording&);
  chart::LegendAt legend_at;
};

constexpr std::array kAxes = std::to_array<OverlayAxis>(
    {{0, "path of the drive since the slip began", "m",
      [](const Recording& recording) { return recording.conditions().speed_m_per_s; }, chart::LegendAt::Above},
     {1, "time since the slip began", "s", [](const Recording&) { return 1.0; }, chart::LegendAt::None}});

/// Around the slip, in the SI unit of the axis.
struct Reach {
  double before = 0.0;
  double after = 0.0;
};

/// Returns the window of a recording, or nothing if it has no cycles or too few samples in it.
std::optional<CycleWindow> window_of(const OverlaidRecording& one, const OverlayAxis& axis) {
  if (!shows_cycles(one.analysis) || stack_of(one.analysis, 1).anchors.empty()) return std::nullopt;
  const auto windows = windows_of(one.analysis.cycles, one.recording.sample_interval_s());
  return axis.window < windows.size() ? std::optional(windows[axis.window]) : std::nullopt;
}

/// The widest of any recording.
Reach reach_of(const std::vector<OverlaidSet>& sets, const OverlayAxis& axis) {
  Reach reach;
  for (const OverlaidSet& set : sets) {
    for (const OverlaidRecording& one : set.recordings) {
      const CycleWindow window = window_of(one, axis).value_or(CycleWindow{});
      const double scale = axis.per_second(one.recording);
      reach = {std::max(reach.before, scale * window.before_s), std::max(reach.after, scale * window.after_s)};
    }
  }
  return reach;
}

/// The one that suits the largest force of all.
DisplayUnit force_unit_of_all(const std::vector<OverlaidSet>& sets) {
  std::vector<DisplayUnit> units;
  for (const OverlaidSet& set : sets) {
    for (const OverlaidRecording& one : set.recordings) units.push_back(force_unit_of(one.recording));
  }
  return *std::ranges::min_element(units,
                                   [](const DisplayUnit& a, const DisplayUnit& b) { return a.per_SI < b.per_SI; });
}

/// Colours in the order of the sets; further rounds in other strokes.
struct Look {
  Colour colour;
  Stroke stroke;
};

Look look_of(std::size_t set) {
  constexpr std::array kColours{Colour::Blue,   Colour::Vermillion, Colour::Green, Colour::Purple,
                                Colour::Orange, Colour::SkyBlue,    Colour::Black, Colour::Yellow};
  constexpr std::array kStrokes{Stroke::Solid, Stroke::Dashed};
  return {kColours.at(set % kColours.size()), kStrokes.at(set / kColours.size() % kStrokes.size())};
}

/// A panel of the overlay, filled set by set.
class OverlayPanel {
 public:
  OverlayPanel(const OverlayAxis& axis, const std::vector<OverlaidSet>& sets)
      : axis_(axis),
        reach_(reach_of(sets, axis)),
        unit_(display_unit(axis.unit, reach_.after)),
        force_(force_unit_of_all(sets)),
        most_cycles_(std::clamp<std::size_t>(kMostCycles / sets.size(), 2, kMostCyclesOfASet)) {}

  [[nodiscard]] bool is_empty() const { return reach_.after == 0.0; }

  void add(const OverlaidSet& set, Look look, double width_px) {
    chart::Line line{set.name, look.colour, look.stroke, {}, width_px};
    const std::size_t each = std::max<std::size_t>(1, most_cycles_ / std::max<std::size_t>(1, set.recordings.size()));
    for (const OverlaidRecording& one : set.recordings) add_cycles(one, each, line);
    panel_.lines.push_back(std::move(line));
  }

  /// Adds the fit without the interference, whose phase differs from cycle to cycle.
  void add_fit(const Source& source) {
    std::vector<double> fit = source.fitted;
    for (std::size_t i = 0; i < fit.size(); ++i) fit[i] -= source.recording.force()[i] - source.force_of_slips[i];
    const double per_second = axis_.per_second(source.recording);
    chart::Line line{"fit of a typical cycle", Colour::Vermillion, Stroke::Solid,
                     laid(source, fit, stack_of(source.analysis, 1).typical, window_at(per_second)), 2.4};
    for (chart::Point& point : line.points) point.x *= unit_.per_SI * per_second;
    const bool is_known = std::ranges::any_of(line.points, [](const chart::Point& p) { return std::isfinite(p.y); });
    if (is_known) panel_.lines.push_back(std::move(line));
  }

  [[nodiscard]] chart::Panel finished(const std::string& force_name) const {
    chart::Panel panel = panel_;
    panel.height_px = 280.0;
    panel.legend_at = axis_.legend_at;
    panel.x = {label_with_unit(axis_.label, unit_.unit), -unit_.per_SI * reach_.before, unit_.per_SI * reach_.after};
    const char* const level = on_kinetic_level_ ? " above kinetic level" : " above kinetic level, or trough";
    panel.y = height_.linear_axis(label_with_unit(force_name + level, force_.unit));
    return panel;
  }

 private:
  static constexpr std::size_t kMostCycles = 48;

  [[nodiscard]] CycleWindow window_at(double per_second) const {
    return {reach_.before / per_second, reach_.after / per_second};
  }

  void add_cycles(const OverlaidRecording& one, std::size_t count, chart::Line& line) {
    if (!window_of(one, axis_)) return;
    static const Background kNone;
    const double per_second = axis_.per_second(one.recording);
    const Source source{one.recording, one.analysis, kNone,
                        force_,        {},           force_without_interference(one.recording, one.analysis)};
    const Stack stack = stack_of(one.analysis, count);
    on_kinetic_level_ = on_kinetic_level_ && stack.on_kinetic_level;
    const chart::Line cycles = laid_cycles(source, stack, window_at(per_second));
    for (const chart::Point& point : cycles.points) {
      line.points.push_back({unit_.per_SI * per_second * point.x, point.y});
      height_.add(point.y);
    }
  }

  const OverlayAxis& axis_;
  Reach reach_;
  DisplayUnit unit_;
  DisplayUnit force_;
  std::size_t most_cycles_;
  chart::Panel panel_;
  Span height_;
  bool on_kinetic_level_ = true;
};

/// Returns the recordings with stick-slip, from the slowest to the fastest.
std::vector<OverlaidSet> sets_of(const SweepSource& source) {
  std::vector<OverlaidSet> sets;
  for (const std::size_t i : by_speed(source)) {
    if (source.sweep.recordings[i].motion != MotionClass::StickSlip) continue;
    const SweepEntry& entry = source.entries[i];
    OverlaidSet set{fmt::format("{}, {}", entry.id, speed_text(entry.recording.conditions())),
                    {{entry.recording, source.sweep.recordings[i]}}};
    if (has_cycles(set)) sets.push_back(std::move(set));
  }
  return sets;
}

}  // namespace

bool has_cycles(const OverlaidSet& set) {
  return std::ranges::any_of(set.recordings,
                             [](const OverlaidRecording& one) { return window_of(one, kAxes.front()).has_value(); });
}

chart::Chart overlay_of(const std::string& title, const std::vector<OverlaidSet>& sets, const Source* fitted) {
  chart::Chart chart{title, {}, {}};
  for (const OverlayAxis& axis : kAxes) {
    OverlayPanel panel(axis, sets);
    if (panel.is_empty()) continue;
    for (std::size_t i = 0; i < sets.size(); ++i) {
      fitted != nullptr ? panel.add(sets[i], {Colour::Grey, Stroke::Solid}, 0.6) : panel.add(sets[i], look_of(i), 1.0);
    }
    if (fitted != nullptr) panel.add_fit(*fitted);
    chart.panels.push_back(panel.finished(force_name_of(sets.front().recordings.front().recording)));
  }
  return chart;
}

Figure sweep_cycles_figure(const SweepSource& source) {
  constexpr std::size_t kMostTogether = 16;  // colours and strokes that can be distinguished
  Figure figure{"sweep-cycles", "Overlaid cycles of the recordings", std::string(kOverlayGuide)};
  const std::vector<OverlaidSet> all = sets_of(source);
  if (all.size() < 2) return figure.without_chart("Fewer than two recordings have cycles to overlay.");
  const std::size_t count = std::min(kMostTogether, all.size());
  std::vector<OverlaidSet> shown;
  for (std::size_t i = 0; i < count; ++i) shown.push_back(all[i * all.size() / count]);
  if (count < all.size()) figure.guide += fmt::format(" {} of {} recordings are drawn.", count, all.size());
  figure.label = fmt::format("overlaid cycles of {} recordings, from the slowest to the fastest", count);
  figure.chart = overlay_of(figure.title, shown);
  return figure;
}

}  // namespace slipfit::html
