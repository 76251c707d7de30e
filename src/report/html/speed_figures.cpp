#include "report/html/speed_figures.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "report/html/figure.hpp"
#include "report/quantity_rows.hpp"

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

namespace {

using chart::Colour, chart::Panel, chart::Point, chart::Shape, chart::Stroke;

constexpr double kGap = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kTracesOfPicture = 4;  // no more fit on a printed page
constexpr double kFarthestBound = 5.0;       // factor; what reaches further is cut at the axis

/// One quantity of the recordings over speed, in SI.
struct Series {
  std::vector<double> speeds_m_per_s;
  std::vector<Estimate> estimates;
};

/// One point for each speed: the mean, and an interval that holds those of all. A line through recordings of one speed
/// would run up and down.
Series merged_by_speed(const Series& series) {
  Series merged;
  std::size_t count = 0;
  for (std::size_t i = 0; i < series.estimates.size(); ++i) {
    const Estimate& next = series.estimates[i];
    if (i == 0 || series.speeds_m_per_s[i] != series.speeds_m_per_s[i - 1]) {
      merged.speeds_m_per_s.push_back(series.speeds_m_per_s[i]);
      merged.estimates.push_back(next);
      count = 1;
      continue;
    }
    Estimate& mean = merged.estimates.back();
    ++count;
    *mean.value += (*next.value - *mean.value) / static_cast<double>(count);
    if (mean.ci95 && next.ci95) {
      mean.ci95 = Interval{std::min(mean.ci95->low, next.ci95->low), std::max(mean.ci95->high, next.ci95->high)};
    } else if (next.ci95) {
      mean.ci95 = next.ci95;
    }
  }
  return merged;
}

/// Points sorted by speed; recordings without the quantity are left out.
template <class Pick>
Series series_of(const SweepSource& source, Pick pick) {
  Series series;
  for (const std::size_t i : by_speed(source)) {
    const Estimate estimate = pick(i);
    if (!estimate.value) continue;
    series.speeds_m_per_s.push_back(source.entries[i].recording.conditions().speed_m_per_s);
    series.estimates.push_back(estimate);
  }
  return series;
}

/// A panel over speed, filled series by series.
class SpeedPanel {
 public:
  SpeedPanel(DisplayUnit speed_unit, DisplayUnit unit) : speed_unit_(std::move(speed_unit)), unit_(std::move(unit)) {}

  void add_markers(const std::string& name, Colour colour, Shape shape, const Series& series) {
    if (series.estimates.empty()) return;
    chart::Markers markers{name, colour, shape, {}};
    chart::Line bars{"", colour, Stroke::Solid, {}, 1.6};
    for (std::size_t i = 0; i < series.estimates.size(); ++i) {
      const double speed = at(series.speeds_m_per_s[i]);
      markers.points.push_back(value_point(speed, *series.estimates[i].value));
      if (!series.estimates[i].ci95) continue;
      bars.points.push_back(bound_point(speed, series.estimates[i].ci95->low));
      bars.points.push_back(bound_point(speed, series.estimates[i].ci95->high));
      bars.points.push_back({kGap, kGap});
    }
    panel_.markers.push_back(std::move(markers));
    panel_.lines.push_back(std::move(bars));
  }

  /// The line ends where a value is unknown, the band where an interval is.
  void add_curve(const std::string& name, Colour colour, const Series& series) {
    if (series.estimates.empty()) return;
    chart::Line line{name, colour, Stroke::Solid, {}};
    std::vector<Point> low;
    std::vector<Point> high;
    std::string band = "its 95 % band";
    const auto end_part = [&] {
      if (low.empty()) return;
      low.insert(low.end(), high.rbegin(), high.rend());
      panel_.areas.push_back({std::exchange(band, ""), colour, chart::Fill::Plain, std::exchange(low, {}), kEdge_px});
      high.clear();
    };
    for (std::size_t i = 0; i < series.estimates.size(); ++i) {
      const double speed = at(series.speeds_m_per_s[i]);
      const std::optional<double>& value = series.estimates[i].value;
      line.points.push_back(value ? value_point(speed, *value) : Point{kGap, kGap});
      if (const auto& ci95 = series.estimates[i].ci95; value && ci95) {
        low.push_back(bound_point(speed, ci95->low));
        high.push_back(bound_point(speed, ci95->high));
      } else {
        end_part();
      }
    }
    end_part();
    panel_.lines.push_back(std::move(line));
  }

  /// `critical_speed`: a line across, where its value is known.
  [[nodiscard]] Panel finished(const std::string& label, chart::Scale scale,
                               const Estimate& critical_speed = {}) const {
    Panel panel = panel_;
    panel.height_px = 300.0;
    panel.x = speeds_.logarithmic_axis(label_with_unit("driving speed", speed_unit_.unit));
    const std::string full = label_with_unit(label, unit_.unit);
    if (scale == chart::Scale::Logarithmic) {
      panel.y = heights_with_bounds().logarithmic_axis(full);
      mark_critical_speed(panel, critical_speed);
      return panel;
    }
    Span heights = heights_;
    for (const chart::Line& line : panel.lines) add_to(heights, line.points);
    for (const chart::Area& area : panel.areas) add_to(heights, area.outline);
    panel.y = heights.linear_axis(full);
    return panel;
  }

 private:
  void mark_critical_speed(Panel& panel, const Estimate& critical) const {
    const auto at = [&](double SI) { return std::clamp(speed_unit_.per_SI * SI, panel.x.low, panel.x.high); };
    const double x = at(critical.value.value_or(0.0));
    if (!(panel.x.low < x && x < panel.x.high)) return;
    if (const auto& ci95 = critical.ci95) {
      panel.areas.push_back(
          rectangle("", Colour::Orange, {at(ci95->low), panel.y.low}, {at(ci95->high), panel.y.high}));
    }
    panel.lines.push_back(
        {"stick-slip ends, 95 %", Colour::Orange, Stroke::Dashed, {{x, panel.y.low}, {x, panel.y.high}}});
  }
  double at(double speed_m_per_s) {
    speeds_.add(speed_unit_.per_SI * speed_m_per_s);
    return speed_unit_.per_SI * speed_m_per_s;
  }
  static void add_to(Span& heights, const std::vector<Point>& points) {
    for (const Point& point : points) heights.add(point.y);
  }
  [[nodiscard]] Point point(double speed, double SI) const { return {speed, unit_.per_SI * SI}; }
  Point value_point(double speed, double SI) {
    heights_.add(unit_.per_SI * SI);
    return point(speed, SI);
  }
  Point bound_point(double speed, double SI) {
    bounds_.add(unit_.per_SI * SI);
    return point(speed, SI);
  }
  /// A logarithmic axis reaches to the ends of the intervals, but no further than `kFarthestBound` from the values: an
  /// interval of several decades would make the values look alike.
  [[nodiscard]] Span heights_with_bounds() const {
    Span heights = heights_;
    if (heights_.empty() || bounds_.empty()) return heights;
    heights.add(std::max(bounds_.low(), heights_.low() / kFarthestBound));
    heights.add(std::min(bounds_.high(), heights_.high() * kFarthestBound));
    return heights;
  }

  DisplayUnit speed_unit_;
  DisplayUnit unit_;
  Panel panel_;
  Span speeds_;
  Span heights_;
  Span bounds_;
};

/// Returns the prediction of a model against speed, from the first to the last speed with the quantity; it may be
/// unknown between them.
Series predicted_series(const Prediction& prediction, Estimate PredictedMotion::*quantity) {
  Series series;
  const auto is_known = [quantity](const PredictedMotion& row) { return (row.*quantity).value.has_value(); };
  const auto first = std::find_if(prediction.rows.begin(), prediction.rows.end(), is_known);
  const auto last = std::find_if(prediction.rows.rbegin(), prediction.rows.rend(), is_known).base();
  for (auto row = first; row < last; ++row) {
    series.speeds_m_per_s.push_back(row->speed_m_per_s);
    series.estimates.push_back((*row).*quantity);
  }
  return series;
}

/// One recording: what its fit predicts at other speeds, and the measurement.
Panel panel_over_speed(const Source& source, const std::string& name, const DisplayUnit& unit,
                       Estimate PredictedMotion::*quantity, const Estimate& measured) {
  const Conditions& conditions = source.recording.conditions();
  const Prediction& prediction = *source.background.prediction;
  SpeedPanel panel(speed_unit(conditions.speed_unit, conditions.speed_m_per_s), unit);
  panel.add_curve("predicted", Colour::Blue, predicted_series(prediction, quantity));
  if (measured.value) {
    panel.add_markers("measured, 95 %", Colour::Black, Shape::Dot, {{conditions.speed_m_per_s}, {measured}});
  }
  Panel finished = panel.finished(name, chart::Scale::Logarithmic, prediction.critical_speed_m_per_s);
  finished.height_px = 230.0;
  return finished;
}

/// Returns the spacing by the fit of the sweep against speed, between the recordings with a prediction.
Series fitted_spacing(const SweepSource& source) {
  if (source.prediction) return predicted_series(*source.prediction, &PredictedMotion::periodic_displacement_m);
  const std::vector<SweepPoint>& points = source.sweep.fit->points;
  return merged_by_speed(series_of(source, [&points](std::size_t i) { return points[i].spacing_m; }));
}

Estimate critical_speed_of(const SweepSource& source) {
  return source.prediction ? source.prediction->critical_speed_m_per_s : Estimate{};
}

}  // namespace

Figure speed_figure(const Source& source) {
  Figure figure{"speed", "Spacing and frequency at other speeds"};
  figure.guide =
      "Prediction of the fitted model at other speeds, if friction does not depend on speed. The point is the "
      "measurement; the curve passes through it by construction. If the band ends before the curve, the recording does "
      "not determine whether stick-slip persists.";
  const Analysis& analysis = source.analysis;
  if (!source.background.prediction) {
    const std::string& why = analysis.derived.lambda.note;
    return figure.without_chart("No prediction for other speeds" + (why.empty() ? std::string() : ": " + why) + ".");
  }
  const Prediction& prediction = *source.background.prediction;
  const DisplayUnit length =
      display_unit("m", analysis.derived.pattern_spacing_m.value ? analysis.derived.pattern_spacing_m.value
                                                                 : analysis.derived.periodic_displacement_m.value);
  figure.chart = chart::Chart{
      "Spacing and frequency over speed",
      {},
      {panel_over_speed(source, "pattern spacing", length, &PredictedMotion::periodic_displacement_m,
                        analysis.derived.pattern_spacing_m),
       panel_over_speed(source, "frequency", {1.0, "Hz"}, &PredictedMotion::frequency_Hz, analysis.frequency.quoted)}};
  const Estimate& critical = prediction.critical_speed_m_per_s;
  const DisplayUnit unit = speed_unit(source.recording.conditions().speed_unit, critical.value);
  figure.label =
      fmt::format("predicted pattern spacing and stick-slip frequency over driving speed; critical speed {}",
                  critical.value ? estimate_row(critical, unit).value + " " + unit.unit : std::string("not known"));
  if (!critical.value && !critical.note.empty()) {
    figure.guide += " The critical speed is not known: " + critical.note + ".";
  }
  return figure;
}

Figure sweep_spacing_figure(const SweepSource& source) {
  Figure figure{"sweep-spacing", "Pattern spacing over speed"};
  figure.guide =
      "Dots: measured V/f. Rings: prediction of a fit to all other recordings with its 95 % interval; this tests the "
      "model, because the recording itself was not used. Line: the fit to all recordings with its 95 % band; if the "
      "band ends before the line, the recordings do not determine whether stick-slip persists.";
  if (!source.sweep.fit) return figure.without_chart("There is no joint fit: " + source.sweep.fit_reason + ".");
  const std::vector<SweepPoint>& points = source.sweep.fit->points;
  const Series measured =
      series_of(source, [&source](std::size_t i) { return source.sweep.recordings[i].derived.pattern_spacing_m; });
  const Series left_out = series_of(source, [&points](std::size_t i) { return points[i].spacing_left_out_m; });
  const Series fitted = fitted_spacing(source);
  if (measured.estimates.empty() && fitted.estimates.empty())
    return figure.without_chart("No recording of the sweep shows a pattern.");
  const Series& typical = measured.estimates.empty() ? fitted : measured;
  SpeedPanel panel(speed_unit_of(source), display_unit("m", typical.estimates.front().value));
  panel.add_curve("joint fit", Colour::Blue, fitted);
  panel.add_markers("measured (V/f)", Colour::Black, Shape::Dot, measured);
  panel.add_markers("predicted from the others", Colour::Vermillion, Shape::Ring, left_out);
  const Series worn = series_of(
      source, [&source](std::size_t i) { return spacing_on_surface(source.entries[i].recording.conditions()); });
  if (!worn.estimates.empty()) {
    panel.add_markers("on the worn surface", Colour::Green, Shape::Triangle, worn);
    figure.guide += " Triangles: the pattern on the worn surface, with its 95 % interval if known.";
  }
  figure.chart = chart::Chart{"Pattern spacing over speed",
                              {},
                              {panel.finished("spacing", chart::Scale::Logarithmic, critical_speed_of(source))}};
  figure.label = fmt::format("pattern spacing over driving speed: {} measured, {} predicted by fits without them",
                             measured.estimates.size(), left_out.estimates.size());
  return figure;
}

Figure sweep_friction_figure(const SweepSource& source) {
  Figure figure{"sweep-friction", "Friction over speed",
                "Kinetic friction by the fitted friction law at the speeds of the sweep, with its 95 % band, which "
                "includes the uncertainty of alpha. Dots: mean force of recordings with steady sliding."};
  const std::vector<SweepPoint> points = source.sweep.fit ? source.sweep.fit->points : std::vector<SweepPoint>{};
  const Series law = points.empty() ? Series{} : merged_by_speed(series_of(source, [&points](std::size_t i) {
    return points[i].kinetic_friction_N;
  }));
  if (law.estimates.empty()) return figure.without_chart("Kinetic friction over speed is not known.");
  SpeedPanel panel(speed_unit_of(source), display_unit("N", law.estimates.front().value));
  panel.add_curve("kinetic friction by the fit", Colour::Blue, law);
  panel.add_markers("steady sliding, mean force", Colour::Black, Shape::Dot,
                    series_of(source, [&points](std::size_t i) { return points[i].mean_steady_force_N; }));
  figure.chart = chart::Chart{"Friction over speed", {}, {panel.finished("friction force", chart::Scale::Linear)}};
  figure.label = fmt::format("kinetic friction over driving speed at {} speeds", law.estimates.size());
  return figure;
}

std::vector<Figure> sweep_traces_figures(const SweepSource& source) {
  std::vector<Figure> figures;
  for (std::size_t first = 0; first < source.entries.size(); first += kTracesOfPicture) {
    const auto entries = source.entries.subspan(first, std::min(kTracesOfPicture, source.entries.size() - first));
    Figure figure =
        first == 0
            ? Figure{"sweep-traces", "The recordings",
                     "Each recording against its own time, with its own scale, its own fit and, below it, the residual "
                     "of that fit. The joint fit shares its parameters."}
            : Figure{fmt::format("sweep-traces-{}", figures.size() + 1), "The recordings, continued"};
    chart::Chart chart{"Recordings of the sweep", {}, {}};
    for (std::size_t i = 0; i < entries.size(); ++i) {
      static const Background kNone;
      const Recording& recording = entries[i].recording;
      const std::string name = fmt::format("{}, {}", entries[i].id, speed_text(recording.conditions()));
      const Source one = source_of(recording, source.sweep.recordings[first + i], kNone);
      for (Panel& panel : small_trace(one, name)) chart.panels.push_back(std::move(panel));
    }
    figure.label = fmt::format("force over time of {} recordings", entries.size());
    figure.chart = std::move(chart);
    figures.push_back(std::move(figure));
  }
  return figures;
}

}  // namespace slipfit::html
