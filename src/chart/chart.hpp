#pragma once

#include <string>
#include <vector>

// Charts as SVG: lines, areas, markers and notes on linear or logarithmic axes. Same chart, same bytes. Text stays
// text.

namespace slipfit::chart {

/// The colours of Okabe and Ito (2008), which colour-blind readers tell apart, and a grey.
enum class Colour { Black, Orange, SkyBlue, Green, Yellow, Blue, Vermillion, Purple, Grey };
enum class Stroke { Solid, Dashed, Dotted, DashDotted };
enum class Fill { Plain, Hatched };
enum class Shape { Dot, Ring, Triangle, Cross };
enum class Scale { Linear, Logarithmic };

/// Not finite: a gap in a line.
struct Point {
  double x = 0.0;
  double y = 0.0;
};

/// What has a name stands in the legend.
struct Line {
  std::string name;
  Colour colour = Colour::Black;
  Stroke stroke = Stroke::Solid;
  std::vector<Point> points;
};

struct Area {
  std::string name;
  Colour colour = Colour::Grey;
  Fill fill = Fill::Plain;
  std::vector<Point> outline;
};

struct Markers {
  std::string name;
  Colour colour = Colour::Black;
  Shape shape = Shape::Dot;
  std::vector<Point> points;
};

/// Text beside a point: `degrees` clockwise from right, `distance_px` bridged by a thin line. Negative: text on the
/// point.
struct Note {
  Point at;
  std::string text;
  Colour colour = Colour::Black;
  double degrees = 0.0;
  double distance_px = 0.0;
};

struct Axis {
  std::string label;  ///< with its unit
  double low = 0.0;
  double high = 1.0;
  Scale scale = Scale::Linear;
};

/// 0 = left or bottom, 1 = right or top, as parts of the room inside the axes.
struct Place {
  double right = 0.0;
  double up = 1.0;
};

struct Panel {
  Axis x;
  Axis y;
  double height_px = 330.0;
  Place legend;
  std::vector<Area> areas;  ///< later ones cover earlier ones; all under the lines, markers and notes
  std::vector<Line> lines;
  std::vector<Markers> markers;
  std::vector<Note> notes;
};

/// Panels from top to bottom, about 700 px wide.
struct Chart {
  std::string title;
  std::vector<std::string> remarks;  ///< lines under the title
  std::vector<Panel> panels;
};

std::string to_svg(const Chart& chart);

}  // namespace slipfit::chart
