#include <fmt/format.h>

#include <limits>

#include "report/html/exhibit.hpp"
#include "report/html/scaling.hpp"

namespace slipfit::html {
namespace {

using chart::Colour, chart::Panel, chart::Point, chart::Shape, chart::Stroke;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// One quantity over speed, in the units of the chart.
struct Quantity {
  std::string label;
  double per_SI = 1.0;
  Estimate PredictedMotion::*predicted;
  Estimate measured;
};

struct Curves {
  std::vector<Point> values;
  std::vector<Point> low;
  std::vector<Point> high;
};

Curves curves_of(const Prediction& prediction, const Quantity& quantity, double speed_per_SI) {
  Curves curves;
  for (const PredictedMotion& row : prediction.rows) {
    const Estimate& estimate = row.*quantity.predicted;
    const double speed = speed_per_SI * row.speed_m_per_s;
    curves.values.push_back({speed, estimate.value ? quantity.per_SI * *estimate.value : kNone});
    if (!estimate.ci95) continue;
    curves.low.push_back({speed, quantity.per_SI * estimate.ci95->low});
    curves.high.push_back({speed, quantity.per_SI * estimate.ci95->high});
  }
  return curves;
}

void add_critical_speed(Panel& panel, const Estimate& critical, double speed_per_SI) {
  if (critical.ci95) {
    const double low = speed_per_SI * critical.ci95->low;
    const double high = speed_per_SI * critical.ci95->high;
    panel.areas.push_back({"",
                           Colour::Orange,
                           chart::Fill::Plain,
                           {{low, panel.y.low}, {low, panel.y.high}, {high, panel.y.high}, {high, panel.y.low}}});
  }
  if (!critical.value) return;
  const double at = speed_per_SI * *critical.value;
  panel.lines.push_back(
      {"critical speed, 95 %", Colour::Orange, Stroke::Dashed, {{at, panel.y.low}, {at, panel.y.high}}});
}

void add_measured(Panel& panel, const Quantity& quantity, double speed) {
  if (!quantity.measured.value) return;
  if (quantity.measured.ci95) {
    panel.lines.push_back({"",
                           Colour::Black,
                           Stroke::Solid,
                           {{speed, quantity.per_SI * quantity.measured.ci95->low},
                            {speed, quantity.per_SI * quantity.measured.ci95->high}},
                           2.4});
  }
  panel.markers.push_back(
      {"measured, 95 %", Colour::Black, Shape::Dot, {{speed, quantity.per_SI * *quantity.measured.value}}});
}

Panel panel_of(const Source& source, const Quantity& quantity) {
  const Prediction& prediction = *source.background.prediction;
  const double speed_m_per_s = source.recording.conditions().speed_m_per_s;
  const DisplayUnit unit = speed_unit(source.recording.conditions().speed_unit, speed_m_per_s);
  const Curves curves = curves_of(prediction, quantity, unit.per_SI);
  Span heights;
  for (const auto* points : {&curves.values, &curves.low, &curves.high}) {
    for (const Point& point : *points) heights.add(point.y);
  }
  if (quantity.measured.value) heights.add(quantity.per_SI * *quantity.measured.value);
  Panel panel;
  panel.height_px = 230.0;
  panel.legend_at = chart::LegendAt::Above;
  panel.x = {label_with_unit("driving speed", unit.unit), curves.values.front().x, curves.values.back().x,
             chart::Scale::Logarithmic};
  panel.y = heights.logarithmic_axis(quantity.label);
  std::vector<Point> outline = curves.low;
  outline.insert(outline.end(), curves.high.rbegin(), curves.high.rend());
  if (!outline.empty()) panel.areas.push_back({"95 % of the mean", Colour::Blue, chart::Fill::Plain, outline});
  panel.lines.push_back({"predicted", Colour::Blue, Stroke::Solid, curves.values});
  add_critical_speed(panel, prediction.critical_speed_m_per_s, unit.per_SI);
  add_measured(panel, quantity, unit.per_SI * speed_m_per_s);
  return panel;
}

}  // namespace

Exhibit speed_exhibit(const Source& source) {
  Exhibit exhibit{"speed", "Spacing and frequency at other speeds", {}, {}, {}, {}};
  exhibit.guide =
      "What the fitted model says where nothing was measured, as long as friction does not change with speed. The "
      "point is the measurement; at its own speed the curve must pass through it and proves little. Where the band "
      "ends before the curve, the recording cannot tell whether there still is stick-slip.";
  const Analysis& analysis = source.analysis;
  if (!source.background.prediction) {
    const std::string& why = analysis.derived.lambda.note;
    exhibit.absent = "No prediction for other speeds" + (why.empty() ? std::string() : ": " + why) + ".";
    return exhibit;
  }
  const Prediction& prediction = *source.background.prediction;
  const DisplayUnit length =
      display_unit("m", analysis.derived.pattern_spacing_m.value ? analysis.derived.pattern_spacing_m.value
                                                                 : analysis.derived.periodic_displacement_m.value);
  const Quantity spacing{label_with_unit("pattern spacing", length.unit), length.per_SI,
                         &PredictedMotion::periodic_displacement_m, analysis.derived.pattern_spacing_m};
  const Quantity frequency{label_with_unit("frequency", "Hz"), 1.0, &PredictedMotion::frequency_Hz,
                           analysis.frequency.quoted};
  exhibit.chart =
      chart::Chart{"Spacing and frequency over speed", {}, {panel_of(source, spacing), panel_of(source, frequency)}};
  const Estimate& critical = prediction.critical_speed_m_per_s;
  const DisplayUnit unit = speed_unit(source.recording.conditions().speed_unit, critical.value);
  exhibit.label =
      fmt::format("predicted pattern spacing and stick-slip frequency over driving speed; critical speed {}",
                  critical.value ? fmt::format("{} {}", rounded(scaled(critical, unit.per_SI)).value, unit.unit)
                                 : std::string("not known"));
  if (!critical.value && !critical.note.empty()) {
    exhibit.guide += " The critical speed is not known: " + critical.note + ".";
  }
  return exhibit;
}

}  // namespace slipfit::html
