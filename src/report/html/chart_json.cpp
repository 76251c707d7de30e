#include <array>
#include <utility>
#include <vector>

#include "chart/svg.hpp"
#include "report/html/figure.hpp"
#include "report/html/speed_figures.hpp"
#include "report/json_values.hpp"
#include "slipfit/report/html.hpp"
#include "slipfit/report/sweep_html.hpp"

// Charts for programs that draw them: what svg.cpp draws, as data.

namespace slipfit {
namespace {

constexpr std::array kStrokes{"solid", "dashed", "dotted", "dashdot"};      // by Stroke
constexpr std::array kShapes{"dot", "speck", "ring", "triangle", "cross"};  // by Shape

Json points_json(const std::vector<chart::Point>& points) {
  Json x = Json::array();
  Json y = Json::array();
  for (const chart::Point& point : points) {
    x.push_back(point.x);
    y.push_back(point.y);
  }
  return {std::move(x), std::move(y)};
}

Json axis_json(const chart::Axis& axis) {
  return {{"label", axis.label},
          {"low", axis.low},
          {"high", axis.high},
          {"scale", axis.scale == chart::Scale::Logarithmic ? "log" : "linear"}};
}

Json panel_json(const chart::Panel& panel) {
  const chart::Drawing colours(chart::Palette::File);
  Json json{{"x", axis_json(panel.x)}, {"y", axis_json(panel.y)}, {"height_px", panel.height_px}};
  json["areas"] = array_of(panel.areas, [&](const chart::Area& area) {
    return Json{{"name", area.name}, {"colour", colours.name_of(area.colour)}, {"points", points_json(area.outline)}};
  });
  json["lines"] = array_of(panel.lines, [&](const chart::Line& line) {
    return Json{{"name", line.name},
                {"colour", colours.name_of(line.colour)},
                {"stroke", kStrokes.at(static_cast<std::size_t>(line.stroke))},
                {"width_px", line.width_px},
                {"points", points_json(line.points)}};
  });
  json["markers"] = array_of(panel.markers, [&](const chart::Markers& markers) {
    return Json{{"name", markers.name},
                {"colour", colours.name_of(markers.colour)},
                {"shape", kShapes.at(static_cast<std::size_t>(markers.shape))},
                {"points", points_json(markers.points)}};
  });
  json["notes"] = array_of(panel.notes, [&](const chart::Note& note) {
    return Json{{"text", note.text}, {"colour", colours.name_of(note.colour)}, {"x", note.at.x}, {"y", note.at.y}};
  });
  return json;
}

std::string charts_json(const std::vector<html::Figure>& figures, std::string_view which) {
  Json json = Json::object();
  for (const html::Figure& figure : figures) {
    if (!figure.id.starts_with(which)) continue;
    Json& one = json[figure.id];
    one = {{"title", figure.title}, {"guide", figure.guide}, {"absent", figure.absent}};
    one["panels"] = figure.chart ? array_of(figure.chart->panels, panel_json) : Json::array();
  }
  return text_of(json, JsonLayout::OneLine);
}

}  // namespace

std::string report_charts(const Recording& recording, const Analysis& analysis, const Background& background,
                          std::string_view which) {
  html::Source source = html::source_of(recording, analysis, background);
  source.trace_columns = recording.size();
  return charts_json(html::figures_of(source), which);
}

std::string report_charts(std::span<const SweepEntry> entries, const SweepAnalysis& sweep,
                          const std::optional<Prediction>& prediction, std::string_view which) {
  const html::SweepSource source{entries, sweep, prediction};
  std::vector<html::Figure> figures{html::sweep_spacing_figure(source), html::sweep_friction_figure(source),
                                    html::sweep_cycles_figure(source)};
  for (html::Figure& figure : html::sweep_traces_figures(source)) figures.push_back(std::move(figure));
  return charts_json(figures, which);
}

}  // namespace slipfit
