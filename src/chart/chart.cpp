#include "chart/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

#include "chart/ticks.hpp"

namespace slipfit::chart {
namespace {

// Pixels.
constexpr double kLeft = 74.0;
constexpr double kWidth = 610.0;  // of the axes
constexpr double kRight = 16.0;
constexpr double kAxisRoom = 52.0;  // below the axes: values and label
constexpr double kLineHeight = 18.0;
constexpr double kCharacter = 6.6;  // mean width of a letter at 12 px, for the legend's box
constexpr double kSample = 26.0;    // length of a line in the legend

// In the order of Colour, Stroke.
constexpr std::array kColours{"#000000", "#E69F00", "#56B4E9", "#009E73", "#C8BD20",
                              "#0072B2", "#D55E00", "#CC79A7", "#6F6F6F"};
constexpr std::array kDashes{"", "8 4", "2 3", "10 3 2 3"};

template <class Choice>
std::size_t index_of(Choice choice) {
  return static_cast<std::size_t>(choice);
}

const char* name_of(Colour colour) {
  return kColours[index_of(colour)];
}

/// Text from outside must stay text.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

class Drawing {
 public:
  void text(double x, double y, const std::string& content, const char* css_class, const std::string& more = {}) {
    fmt::format_to(out(), "<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"{}\"{}>{}</text>\n", x, y, css_class, more,
                   escaped(content));
  }
  void line(double x1, double y1, double x2, double y2, const std::string& style) {
    fmt::format_to(out(), "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", x1, y1, x2, y2,
                   style);
  }
  void box(double x, double y, double width, double height, const std::string& style) {
    fmt::format_to(out(), "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" {}/>\n", x, y, width,
                   height, style);
  }
  void path(const std::string& data, const std::string& style) {
    fmt::format_to(out(), "<path d=\"{}\" {}/>\n", data, style);
  }
  void raw(const std::string& element) { svg_ += element; }

  [[nodiscard]] const std::string& svg() const { return svg_; }

 private:
  std::back_insert_iterator<std::string> out() { return std::back_inserter(svg_); }
  std::string svg_;
};

std::string stroke_style(Colour colour, Stroke stroke) {
  const char* dashes = kDashes[index_of(stroke)];
  return fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"2\"{}", name_of(colour),
                     *dashes == '\0' ? "" : fmt::format(" stroke-dasharray=\"{}\"", dashes));
}

std::string area_style(Colour colour, Fill fill) {
  if (fill == Fill::Hatched) return fmt::format("fill=\"url(#hatch{})\"", index_of(colour));
  return fmt::format("fill=\"{}\" fill-opacity=\"0.3\"", name_of(colour));
}

void draw_marker(Drawing& drawing, double x, double y, Colour colour, Shape shape) {
  const std::string place = fmt::format("transform=\"translate({:.1f} {:.1f})\" ", x, y);
  const char* name = name_of(colour);
  const std::string ring = fmt::format("fill=\"#FFF\" stroke=\"{}\" stroke-width=\"2\"", name);
  switch (shape) {
    case Shape::Dot:
      drawing.path("M-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0z", place + fmt::format("fill=\"{}\"", name));
      break;
    case Shape::Ring:
      drawing.path("M-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0z", place + ring);
      break;
    case Shape::Triangle:
      drawing.path("M0 -5 5 4 -5 4z", place + ring);
      break;
    case Shape::Cross:
      drawing.path("M-4 -4 4 4M-4 4 4 -4", place + fmt::format("stroke=\"{}\" stroke-width=\"2.4\"", name));
      break;
  }
}

/// One panel: from values to pixels.
class PanelDrawing {
 public:
  PanelDrawing(Drawing& drawing, const Panel& panel, double top, std::size_t number)
      : drawing_(drawing), panel_(panel), top_(top), bottom_(top + panel.height_px), number_(number) {}

  void draw() {
    draw_grid();
    drawing_.raw(
        fmt::format("<clipPath id=\"inside{}\"><rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
                    "height=\"{:.1f}\"/></clipPath>\n<g clip-path=\"url(#inside{})\">\n",
                    number_, kLeft, top_, kWidth, panel_.height_px, number_));
    for (const Area& area : panel_.areas) drawing_.path(path_of(area.outline), area_style(area.colour, area.fill));
    for (const Line& line : panel_.lines) drawing_.path(path_of(line.points), stroke_style(line.colour, line.stroke));
    drawing_.raw("</g>\n");
    for (const Markers& markers : panel_.markers) {
      for (const Point& p : markers.points) draw_marker(drawing_, x_of(p.x), y_of(p.y), markers.colour, markers.shape);
    }
    for (const Note& note : panel_.notes) draw_note(note);
    draw_legend();
  }

 private:
  static double share(const Axis& axis, double value) {
    if (axis.scale == Scale::Logarithmic) return std::log(value / axis.low) / std::log(axis.high / axis.low);
    return (value - axis.low) / (axis.high - axis.low);
  }
  /// Far outside values are held near the axes: SVG programs draw huge coordinates badly.
  [[nodiscard]] double x_of(double x) const { return kLeft + kWidth * std::clamp(share(panel_.x, x), -3.0, 4.0); }
  [[nodiscard]] double y_of(double y) const {
    return bottom_ - panel_.height_px * std::clamp(share(panel_.y, y), -3.0, 4.0);
  }

  [[nodiscard]] std::string path_of(const std::vector<Point>& points) const {
    std::string data;
    bool pen_down = false;
    for (const Point& point : points) {
      const double x = x_of(point.x);
      const double y = y_of(point.y);
      const bool finite = std::isfinite(x) && std::isfinite(y);
      if (finite) data += fmt::format("{}{:.1f} {:.1f}", pen_down ? "L" : "M", x, y);
      pen_down = finite;
    }
    return data;
  }

  void draw_grid() {
    for (const Tick& tick : ticks_of(panel_.x)) {
      const double x = x_of(tick.value);
      drawing_.line(x, top_, x, bottom_, "class=\"grid\"");
      if (!tick.text.empty()) drawing_.text(x, bottom_ + 17.0, tick.text, "value", " text-anchor=\"middle\"");
    }
    for (const Tick& tick : ticks_of(panel_.y)) {
      const double y = y_of(tick.value);
      drawing_.line(kLeft, y, kLeft + kWidth, y, "class=\"grid\"");
      if (!tick.text.empty()) drawing_.text(kLeft - 7.0, y + 4.0, tick.text, "value", " text-anchor=\"end\"");
    }
    drawing_.box(kLeft, top_, kWidth, panel_.height_px, "class=\"axes\"");
    drawing_.text(kLeft + 0.5 * kWidth, bottom_ + 38.0, panel_.x.label, "label", " text-anchor=\"middle\"");
    const double middle = 0.5 * (top_ + bottom_);
    drawing_.text(18.0, middle, panel_.y.label, "label",
                  fmt::format(" text-anchor=\"middle\" transform=\"rotate(-90 18 {:.1f})\"", middle));
  }

  void draw_note(const Note& note) {
    const double x = x_of(note.at.x);
    const double y = y_of(note.at.y);
    const double angle = note.degrees * std::numbers::pi / 180.0;
    const double distance = std::abs(note.distance_px);
    const double end_x = x + distance * std::cos(angle);
    const double end_y = y + distance * std::sin(angle);
    if (note.distance_px > 0.0) {
      drawing_.line(x, y, end_x, end_y, fmt::format("stroke=\"{}\" stroke-width=\"0.8\"", name_of(note.colour)));
    }
    const double side = std::cos(angle);
    const char* anchor = note.distance_px < 0.0 || std::abs(side) < 0.3 ? "middle" : side > 0.0 ? "start" : "end";
    const double room = std::abs(side) < 0.3 ? 0.0 : side > 0.0 ? 4.0 : -4.0;
    const double drop = std::abs(side) < 0.3 ? (std::sin(angle) > 0.0 ? 13.0 : -4.0) : 4.0;
    drawing_.text(end_x + room, end_y + drop, note.text, "note",
                  fmt::format(" text-anchor=\"{}\" style=\"fill:{}\"", anchor, name_of(note.colour)));
  }

  void draw_legend() {
    std::vector<std::string> names;
    for (const Line& line : panel_.lines) names.push_back(line.name);
    for (const Markers& markers : panel_.markers) names.push_back(markers.name);
    for (const Area& area : panel_.areas) names.push_back(area.name);
    std::size_t shown = 0;
    std::size_t longest = 0;
    for (const std::string& name : names) {
      shown += name.empty() ? 0U : 1U;
      longest = std::max(longest, name.size());
    }
    if (shown == 0) return;
    const double width = kSample + 22.0 + kCharacter * static_cast<double>(longest);
    const double height = 10.0 + kLineHeight * static_cast<double>(shown);
    const double left = kLeft + 8.0 + panel_.legend.right * (kWidth - 16.0 - width);
    double y = top_ + 8.0 + (1.0 - panel_.legend.up) * (panel_.height_px - 16.0 - height);
    drawing_.box(left, y, width, height, "class=\"legend\"");
    y += 4.0 - 0.5 * kLineHeight;
    const auto next_row = [&](const std::string& name) {
      y += kLineHeight;
      drawing_.text(left + kSample + 14.0, y + 5.0, name, "value");
    };
    const double begin = left + 7.0;
    for (const Line& line : panel_.lines) {
      if (line.name.empty()) continue;
      next_row(line.name);
      drawing_.line(begin, y + 1.0, begin + kSample, y + 1.0, stroke_style(line.colour, line.stroke));
    }
    for (const Markers& markers : panel_.markers) {
      if (markers.name.empty()) continue;
      next_row(markers.name);
      draw_marker(drawing_, begin + 0.5 * kSample, y + 1.0, markers.colour, markers.shape);
    }
    for (const Area& area : panel_.areas) {
      if (area.name.empty()) continue;
      next_row(area.name);
      drawing_.box(begin, y - 5.0, kSample, 12.0, area_style(area.colour, area.fill));
    }
  }

  Drawing& drawing_;
  const Panel& panel_;
  double top_;
  double bottom_;
  std::size_t number_;
};

std::string hatches() {
  std::string patterns = "<defs>\n";
  for (std::size_t i = 0; i < kColours.size(); ++i) {
    patterns += fmt::format(
        "<pattern id=\"hatch{}\" width=\"8\" height=\"8\" patternUnits=\"userSpaceOnUse\" "
        "patternTransform=\"rotate(40)\">"
        "<path d=\"M0 0V8\" stroke=\"{}\" stroke-width=\"2\"/></pattern>\n",
        i, kColours[i]);
  }
  return patterns + "</defs>\n";
}

constexpr const char* kStyle =
    "<style>text{font-family:Helvetica,Arial,sans-serif;fill:#222}.title{font-size:16px;font-weight:bold}"
    ".remark{font-size:12px}.label{font-size:13px}.value{font-size:12px}.note{font-size:12px}"
    ".grid{stroke:#DDD;stroke-width:0.7}.axes{fill:none;stroke:#444}"
    ".legend{fill:#FFF;fill-opacity:0.85;stroke:#CCC;stroke-width:0.7}</style>\n";

}  // namespace

std::string to_svg(const Chart& chart) {
  Drawing drawing;
  double y = 24.0;
  drawing.text(kLeft, y, chart.title, "title");
  for (const std::string& remark : chart.remarks) drawing.text(kLeft, y += kLineHeight, remark, "remark");
  y += 14.0;
  for (std::size_t i = 0; i < chart.panels.size(); ++i) {
    PanelDrawing(drawing, chart.panels[i], y, i).draw();
    y += chart.panels[i].height_px + kAxisRoom;
  }
  const double width = kLeft + kWidth + kRight;
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
             "{1:.0f}\">\n",
             width, y) +
         kStyle + hatches() + "<rect width=\"100%\" height=\"100%\" fill=\"#FFF\"/>\n" + drawing.svg() + "</svg>\n";
}

}  // namespace slipfit::chart
