#include <fmt/format.h>

#include <algorithm>

#include "report/html/figure.hpp"
#include "report/html/scaling.hpp"

namespace slipfit::html {
namespace {

using chart::Colour, chart::Panel, chart::Point, chart::Shape, chart::Stroke;

constexpr std::size_t kTraceColumns = 400;  // of the picture: one for 1.5 pixels
constexpr std::size_t kCyclesClose = 5;     // seen close up
constexpr std::size_t kFewSamples = 150;    // of the close-up: so few are drawn one by one

/// A piece of the recording in the units of the chart.
struct Piece {
  std::vector<double> time_s, force, fitted, residual;
};

Piece cut(const Source& source, SampleRange range) {
  const Recording& recording = source.recording;
  const std::vector<double>& fitted = source.fitted;
  const double scale = source.force_unit.per_SI;
  Piece piece;
  for (std::size_t i = range.begin; i < range.end; ++i) {
    piece.time_s.push_back(recording.time_s()[i]);
    piece.force.push_back(scale * recording.force()[i]);
    piece.fitted.push_back(scale * fitted[i]);
    piece.residual.push_back(scale * (recording.force()[i] - fitted[i]));
  }
  return piece;
}

chart::Axis axis_of(const std::vector<Point>& points, const std::string& label) {
  Span span;
  for (const Point& point : points) span.add(point.y);
  return span.linear_axis(label);
}

chart::Axis time_axis(const Piece& piece, const std::string& label) {
  return {label, piece.time_s.front(), piece.time_s.back()};
}

Panel force_panel(const Piece& piece, const std::string& label, double width_px) {
  Panel panel;
  panel.height_px = 220.0;
  panel.lines = {
      {"measured", Colour::Grey, Stroke::Solid, envelope(piece.time_s, piece.force, kTraceColumns), width_px},
      {"fit", Colour::Vermillion, Stroke::Solid, envelope(piece.time_s, piece.fitted, kTraceColumns), width_px + 0.4}};
  panel.x = time_axis(piece, "time [s]");
  panel.y = axis_of(panel.lines.front().points, label);
  return panel;
}

/// A few cycles in the middle of those that the fit uses (or of all).
SampleRange middle_cycles(const Source& source) {
  std::vector<const Cycle*> cycles;
  for (const Cycle& cycle : source.analysis.cycle_table) {
    if (cycle.used || source.analysis.cycles.used == 0) cycles.push_back(&cycle);
  }
  if (cycles.size() < 3) return {};
  const std::size_t count = std::min(kCyclesClose, cycles.size() - 1);
  const std::size_t first = (cycles.size() - 1 - count) / 2;
  return samples_between(source.recording, cycles[first]->trough_s, cycles[first + count]->trough_s);
}

/// Grey behind what slides, where that is not all.
void mark_sliding(Panel& panel, const Source& source) {
  const TimeSpan& sliding = source.analysis.sliding;
  if (!(sliding.end_s - sliding.begin_s < source.recording.duration_s()) || !(sliding.end_s > sliding.begin_s)) return;
  panel.areas.push_back(
      rectangle("sliding", Colour::Grey, {sliding.begin_s, panel.y.low}, {sliding.end_s, panel.y.high}));
}

/// Marks the start and end of slips, by the fit or by the turning points.
void add_cycle_marks(Panel& panel, const Source& source) {
  const double scale = source.force_unit.per_SI;
  chart::Markers begin{"slip begins", Colour::Blue, Shape::Ring, {}};
  chart::Markers end{"slip ends", Colour::Blue, Shape::Cross, {}};
  for (const Cycle& cycle : source.analysis.cycle_table) {
    const double begin_s = cycle.onset_s.value_or(cycle.peak_s);
    const double end_s = cycle.end_s.value_or(cycle.trough_s);
    if (begin_s < panel.x.low || end_s > panel.x.high) continue;
    begin.points.push_back({begin_s, scale * cycle.onset_force.value_or(cycle.peak_force)});
    end.points.push_back({end_s, scale * cycle.trough_force});
  }
  panel.markers.push_back(begin);
  panel.markers.push_back(end);
}

Panel close_up(const Piece& piece, const Source& source, const std::string& label) {
  Panel panel = force_panel(piece, label, 1.6);
  panel.lines.front().name = "measured, enlarged";
  if (piece.time_s.size() <= kFewSamples) {
    panel.markers.push_back({"", Colour::Grey, Shape::Speck, panel.lines.front().points});
  }
  add_cycle_marks(panel, source);
  return panel;
}

Panel residual_panel(const Piece& piece, const std::string& unit) {
  Panel panel;
  panel.height_px = 90.0;
  panel.lines = {{"", Colour::Blue, Stroke::Solid, envelope(piece.time_s, piece.residual, kTraceColumns), 1.2}};
  panel.x = time_axis(piece, "time [s]");
  panel.y = axis_of(panel.lines.front().points, label_with_unit("residual", unit));
  return panel;
}

}  // namespace

std::vector<Panel> small_trace(const Source& source, const std::string& name) {
  const Piece piece = cut(source, {0, source.recording.size()});
  std::vector<Panel> panels{force_panel(piece, label_with_unit("force", source.force_unit.unit), 1.0)};
  Panel& force = panels.front();
  force.height_px = 80.0;
  force.lines.front().name = name;
  if (!has_fitted_curve(source.analysis)) {
    force.lines.pop_back();
    return panels;
  }
  force.x.label.clear();  // it is below the residual
  panels.push_back(residual_panel(piece, source.force_unit.unit));
  panels.back().height_px = 75.0;
  return panels;
}

Figure trace_figure(const Source& source) {
  const Recording& recording = source.recording;
  const std::string unit = source.force_unit.unit;
  const std::string label = label_with_unit(force_name_of(recording), unit);
  const bool has_fit = has_fitted_curve(source.analysis);

  Figure figure{"trace", has_fit ? "The recording and the fit" : "The recording"};
  figure.guide = !has_fit ? "Measured force, without a fit."
                          : "Measured force, fitted force, and residual (measured minus fitted). The residual should "
                            "be noise; a pattern that repeats in every slip shows that the model lacks something.";
  chart::Chart chart{"Recording and fit", {}, {}};
  chart.panels.push_back(force_panel(cut(source, {0, recording.size()}), label, 1.0));
  mark_sliding(chart.panels.back(), source);
  const SampleRange close = shows_cycles(source.analysis) ? middle_cycles(source) : SampleRange{};
  if (close.size() > 2) {
    const Piece piece = cut(source, close);
    chart.panels.push_back(close_up(piece, source, label));
    if (has_fit) chart.panels.push_back(residual_panel(piece, unit));
  }
  for (chart::Panel& panel : chart.panels) {
    if (!has_fit && panel.lines.size() > 1) panel.lines.pop_back();
  }
  figure.label =
      fmt::format("{} over {}, {}{}", force_name_of(recording), quantity_text(recording.duration_s(), "s"),
                  shows_cycles(source.analysis) ? fmt::format("{} slips marked", source.analysis.cycles.count)
                                                : std::string("steady sliding"),
                  has_fit ? ", with the fitted force and the residual" : ", without a fit");
  figure.chart = std::move(chart);
  return figure;
}

}  // namespace slipfit::html
