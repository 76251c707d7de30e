#include "report/html/speed_figures.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "report/html/figure.hpp"

namespace slipfit::html {

namespace {

using chart::Colour, chart::Panel, chart::Point, chart::Shape, chart::Stroke;

constexpr double kGap = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kTracesOfPicture = 4;  // no more fit on a printed page
constexpr double kFarthestBound = 5.0;       // factor; what reaches further is cut at the axis

/// A quantity at a speed, in SI.
struct SpeedPoint {
  double speed_m_per_s = 0.0;
  Estimate estimate;
};
using Series = std::vector<SpeedPoint>;

/// One point for each speed: the mean, and an interval that holds those of all. A line through recordings of one speed
/// would run up and down.
Series merged_by_speed(const Series& series) {
  Series merged;
  double count = 0.0;
  for (const SpeedPoint& next : series) {
    if (merged.empty() || next.speed_m_per_s != merged.back().speed_m_per_s) {
      merged.push_back(next);
      count = 1.0;
      continue;
    }
    Estimate& mean = merged.back().estimate;
    *mean.value += (*next.estimate.value - *mean.value) / ++count;
    const std::optional<Interval>& ci95 = next.estimate.ci95;
    if (ci95) {
      const Interval before = mean.ci95.value_or(*ci95);
      mean.ci95 = Interval{std::min(before.low, ci95->low), std::max(before.high, ci95->high)};
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
    if (estimate.value) series.push_back({source.entries[i].recording.conditions().speed_m_per_s, estimate});
  }
  return series;
}

/// A panel over speed, filled series by series.
class SpeedPanel {
 public:
  SpeedPanel(DisplayUnit speed_unit, DisplayUnit unit) : speed_unit_(std::move(speed_unit)), unit_(std::move(unit)) {}

  void add_markers(const std::string& name, Colour colour, Shape shape, const Series& series) {
    if (series.empty()) return;
    chart::Markers markers{name, colour, shape, {}};
    chart::Line bars{"", colour, Stroke::Solid, {}, 1.6};
    for (const auto& [speed_m_per_s, estimate] : series) {
      markers.points.push_back(at(speed_m_per_s, *estimate.value));
      if (!estimate.ci95) continue;
      bars.points.push_back(at(speed_m_per_s, estimate.ci95->low));
      bars.points.push_back(at(speed_m_per_s, estimate.ci95->high));
      bars.points.push_back({kGap, kGap});
    }
    panel_.markers.push_back(std::move(markers));
    panel_.lines.push_back(std::move(bars));
  }

  /// The line ends where a value is unknown, the band where an interval is.
  void add_curve(const std::string& name, Colour colour, const Series& series) {
    if (series.empty()) return;
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
    for (const auto& [speed_m_per_s, estimate] : series) {
      line.points.push_back(estimate.value ? at(speed_m_per_s, *estimate.value) : Point{kGap, kGap});
      if (estimate.value && estimate.ci95) {
        low.push_back(at(speed_m_per_s, estimate.ci95->low));
        high.push_back(at(speed_m_per_s, estimate.ci95->high));
      } else {
        end_part();
      }
    }
    end_part();
    panel_.lines.push_back(std::move(line));
  }

  /// `critical_speed`: a line across, where its value is known. A logarithmic axis reaches to the ends of the
  /// intervals, but no further than `kFarthestBound` from the values: an interval of several decades would make the
  /// values look alike.
  [[nodiscard]] Panel finished(const std::string& label, chart::Scale scale,
                               const Estimate& critical_speed = {}) const {
    Span speeds;
    Span values;
    Span bounds;
    const auto add = [&speeds](Span& heights, const std::vector<Point>& points) {
      speeds.add(points, &Point::x);
      heights.add(points);
    };
    for (const chart::Markers& markers : panel_.markers) add(values, markers.points);
    for (const chart::Line& line : panel_.lines) add(line.name.empty() ? bounds : values, line.points);
    for (const chart::Area& area : panel_.areas) add(bounds, area.outline);
    const bool is_logarithmic = scale == chart::Scale::Logarithmic;
    if (!bounds.empty()) {
      const double low = bounds.low();
      const double high = bounds.high();
      const Span known = values;
      values.add(is_logarithmic ? std::max(low, known.low() / kFarthestBound) : low);
      values.add(is_logarithmic ? std::min(high, known.high() * kFarthestBound) : high);
    }
    Panel panel = panel_;
    panel.height_px = 300.0;
    panel.x = speeds.logarithmic_axis(label_with_unit("driving speed", speed_unit_.unit));
    const std::string full = label_with_unit(label, unit_.unit);
    panel.y = is_logarithmic ? values.logarithmic_axis(full) : values.linear_axis(full);
    mark_critical_speed(panel, critical_speed);
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
    panel.lines.push_back(line_up(panel, "stick-slip ends, 95 %", x, Colour::Orange));
  }
  [[nodiscard]] Point at(double speed_m_per_s, double SI) const {
    return {speed_unit_.per_SI * speed_m_per_s, unit_.per_SI * SI};
  }

  DisplayUnit speed_unit_;
  DisplayUnit unit_;
  Panel panel_;
};

/// Returns the prediction of a model against speed, from the first to the last speed with the quantity; it may be
/// unknown between them.
Series predicted_series(const Prediction& prediction, Estimate PredictedMotion::*quantity) {
  Series series;
  for (const PredictedMotion& row : prediction.rows) {
    if (!series.empty() || (row.*quantity).value) series.push_back({row.speed_m_per_s, row.*quantity});
  }
  while (!series.empty() && !series.back().estimate.value) series.pop_back();
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
    panel.add_markers("measured, 95 %", Colour::Black, Shape::Dot, {{conditions.speed_m_per_s, measured}});
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
    figure.guide +=
        " The critical speed is not known: " + in_speed_unit(critical.note, source.recording.conditions().speed_unit) +
        ".";
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
  if (measured.empty() && fitted.empty()) return figure.without_chart("No recording of the sweep shows a pattern.");
  const Series& typical = measured.empty() ? fitted : measured;
  SpeedPanel panel(speed_unit_of(source), display_unit("m", typical.front().estimate.value));
  panel.add_curve("joint fit", Colour::Blue, fitted);
  panel.add_markers("measured (V/f)", Colour::Black, Shape::Dot, measured);
  panel.add_markers("predicted from the others", Colour::Vermillion, Shape::Ring, left_out);
  const Series worn = series_of(
      source, [&source](std::size_t i) { return spacing_on_surface(source.entries[i].recording.conditions()); });
  if (!worn.empty()) {
    panel.add_markers("on the worn surface", Colour::Green, Shape::Triangle, worn);
    figure.guide += " Triangles: the pattern on the worn surface, with its 95 % interval if known.";
  }
  figure.chart = chart::Chart{"Pattern spacing over speed",
                              {},
                              {panel.finished("spacing", chart::Scale::Logarithmic, critical_speed_of(source))}};
  figure.label = fmt::format("pattern spacing over driving speed: {} measured, {} predicted by fits without them",
                             measured.size(), left_out.size());
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
  if (law.empty()) return figure.without_chart("Kinetic friction over speed is not known.");
  SpeedPanel panel(speed_unit_of(source), display_unit("N", law.front().estimate.value));
  panel.add_curve("kinetic friction by the fit", Colour::Blue, law);
  panel.add_markers("steady sliding, mean force", Colour::Black, Shape::Dot,
                    series_of(source, [&points](std::size_t i) { return points[i].mean_steady_force_N; }));
  figure.chart = chart::Chart{"Friction over speed", {}, {panel.finished("friction force", chart::Scale::Linear)}};
  figure.label = fmt::format("kinetic friction over driving speed at {} speeds", law.size());
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
