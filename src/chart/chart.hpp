#pragma once

#include <string>
#include <vector>

// Charts as SVG: lines, areas, markers and notes on linear or logarithmic axes. Same chart, same bytes. Text stays
// text.

namespace slipfit::chart {

/// The colours of Okabe and Ito (2008), which colour-blind readers can distinguish, the pale ones darker, and a grey.
enum class Colour { Black, Orange, SkyBlue, Green, Yellow, Blue, Vermillion, Purple, Grey };
enum class Stroke { Solid, Dashed, Dotted, DashDotted };
enum class Fill { Plain, Hatched };
enum class Shape { Dot, Speck, Ring, Triangle, Cross };
enum class Scale { Linear, Logarithmic };

/// A point; a coordinate that is not finite makes a gap in a line.
struct Point {
  double x = 0.0;
  double y = 0.0;
};

/// A line of a chart; it is in the legend if it has a name.
struct Line {
  std::string name;
  Colour colour = Colour::Black;
  Stroke stroke = Stroke::Solid;
  std::vector<Point> points;
  double width_px = 2.0;
};

struct Area {
  std::string name;
  Colour colour = Colour::Grey;
  Fill fill = Fill::Plain;
  std::vector<Point> outline;
  double edge_px = 0.0;  ///< of the line around it: the fill alone hardly differs from the paper
};

struct Markers {
  std::string name;
  Colour colour = Colour::Black;
  Shape shape = Shape::Dot;
  std::vector<Point> points;
};

/// Text at the right of a point: `degrees` clockwise from right, less than 70 either way, `distance_px` bridged by a
/// thin line. Negative: text on the point.
struct Note {
  Point at;
  std::string text;
  Colour colour = Colour::Black;
  double degrees = 0.0;
  double distance_px = 0.0;
};

struct Axis {
  std::string label;  ///< with its unit; empty: an axis without values
  double low = 0.0;
  double high = 1.0;
  Scale scale = Scale::Linear;
};

/// The position of the legend: in rows above the axes, or in the panel above, which has the same entries.
enum class LegendAt { Above, None };

struct Panel {
  Axis x{};
  Axis y{};
  double height_px = 330.0;
  std::vector<Area> areas{};  ///< later ones cover earlier ones; all under the lines, markers and notes
  std::vector<Line> lines{};
  std::vector<Markers> markers{};
  std::vector<Note> notes{};
  LegendAt legend_at = LegendAt::Above;
};

/// Panels from top to bottom, with 90 px on both sides of the axes.
struct Chart {
  std::string title;
  std::vector<std::string> remarks;  ///< lines under the title
  std::vector<Panel> panels;
  double width_px = 610.0;  ///< of the axes
};

/// A file of its own.
std::string to_svg(const Chart& chart);

/// The names of a picture on a page: `id` is unique on the page (letters, digits, '-'), `label` describes it for
/// readers who cannot see it.
struct PagePlace {
  std::string id;
  std::string label;
};

/// An element <svg class="chart"> of a page, without title and remarks, as wide as its surroundings. Colours, grid and
/// letters come from the page's style sheet (classes grid, axes, entries, label, value, note). Panels carry
/// their axes, lines, areas and markers their names, as data- attributes: save.js reads the points back from them.
std::string to_page_svg(const Chart& chart, const PagePlace& place);

/// Returns the legend as an element <ul class="legend-list"> that wraps its lines, for screens that are narrower than
/// the chart. `id` is that of the chart on the page. The result is empty if a panel has names that the first one lacks.
std::string to_page_legend(const Chart& chart, const std::string& id);

}  // namespace slipfit::chart
