#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "chart/chart.hpp"
#include "chart/drawing.hpp"

namespace slipfit::chart {
namespace {

// Pixels.
constexpr double kLeft = 74.0;
constexpr double kRight = 16.0;
constexpr double kAxisRoom = 52.0;    // below the axes: values and label
constexpr double kLeastStep = 18.0;   // between values of the axis at the left
constexpr double kDigit = 6.6;        // mean width of one at 12 px
constexpr double kWidestDigit = 7.7;  // of the fonts that readers may have in its place (DejaVu Sans)
constexpr double kBetween = 6.0;      // least gap between two values below

/// Tenths of a pixel as a number of SVG: "12", "-.5"; after another number with a blank where no sign parts them.
std::string tenths(long number, bool follows_number) {
  const long size = std::labs(number);
  std::string text = number < 0 ? "-" : follows_number ? " " : "";
  if (size >= 10 || size == 0) text += std::to_string(size / 10);
  if (size % 10 != 0) text += "." + std::to_string(size % 10);
  return text;
}

/// One panel: from values to pixels.
class PanelDrawing {
 public:
  PanelDrawing(Drawing& drawing, const Panel& panel, double width_px, double top, std::string id)
      : drawing_(drawing),
        panel_(panel),
        width_(width_px),
        x_(drawable(panel.x)),
        y_(drawable(panel.y)),
        top_(top),
        bottom_(top + panel.height_px),
        id_(std::move(id)) {}

  /// `number`: of the panel in its picture.
  void draw(std::size_t number) {
    drawing_.raw(fmt::format("<g{}>\n", drawing_.is_on_page() ? axes_attributes() : std::string()));
    draw_grid();
    drawing_.raw(
        fmt::format("<clipPath id=\"{0}inside{1}\"><rect x=\"{2:.1f}\" y=\"{3:.1f}\" width=\"{4:.1f}\" "
                    "height=\"{5:.1f}\"/></clipPath>\n<g clip-path=\"url(#{0}inside{1})\">\n",
                    id_, number, kLeft, top_, width_, panel_.height_px));
    for (const Area& area : panel_.areas)
      drawing_.path(path_of(area.outline), drawing_.area_style(area, id_) + series_attribute(area.name));
    for (const Line& line : panel_.lines)
      drawing_.path(path_of(line.points), drawing_.stroke_style(line) + series_attribute(line.name));
    drawing_.raw("</g>\n");
    for (const Markers& markers : panel_.markers) {
      std::vector<Point> places;
      for (const Point& p : markers.points) {
        if (has_mark(p)) places.push_back({x_of(p.x), y_of(p.y)});
      }
      drawing_.markers(places, markers.colour, markers.shape, series_attribute(markers.name));
    }
    for (const Note& note : panel_.notes) {
      if (has_mark(note.at)) draw_note(note);
    }
    draw_legend(drawing_, panel_, {kLeft, top_, width_, panel_.height_px}, id_);
    drawing_.raw("</g>\n");
  }

 private:
  /// Returns the attributes with which save.js converts pixels into values: the ends of each axis, 1 if it is
  /// logarithmic, and its position.
  [[nodiscard]] std::string axes_attributes() const {
    const auto axis = [](const Axis& of, double begin, double length) {
      return fmt::format("{} {} {} {:.1f} {:.1f}", of.low, of.high, of.scale == Scale::Logarithmic ? 1 : 0, begin,
                         length);
    };
    return fmt::format(" class=\"panel\" data-axes=\"{}\" data-x=\"{}\" data-y=\"{}\"",
                       escaped(panel_.y.label + " over " + panel_.x.label), axis(x_, kLeft, width_),
                       axis(y_, bottom_, -panel_.height_px));
  }
  [[nodiscard]] std::string series_attribute(const std::string& name) const {
    return drawing_.is_on_page() ? fmt::format(" data-name=\"{}\"", escaped(name)) : std::string();
  }
  static double share(const Axis& axis, double value) {
    if (axis.scale == Scale::Logarithmic) {  // 0 and below: far beneath, so that an outline stays closed
      if (value <= 0.0) return -std::numeric_limits<double>::infinity();
      return (std::log(value) - std::log(axis.low)) / (std::log(axis.high) - std::log(axis.low));
    }
    return (value - axis.low) / (axis.high - axis.low);
  }
  /// Far outside values are held near the axes: SVG programs draw huge coordinates badly.
  [[nodiscard]] double x_of(double x) const { return kLeft + width_ * std::clamp(share(x_, x), -3.0, 4.0); }
  [[nodiscard]] double y_of(double y) const { return bottom_ - panel_.height_px * std::clamp(share(y_, y), -3.0, 4.0); }

  [[nodiscard]] bool has_place(const Point& point) const {
    return std::isfinite(x_of(point.x)) && std::isfinite(y_of(point.y));
  }

  /// Returns true if an isolated point is drawn as a mark.
  [[nodiscard]] bool has_mark(const Point& point) const {
    return std::isfinite(share(x_, point.x)) && std::isfinite(share(y_, point.y));
  }

  /// "M12.3 45l.5-1.2 ...": each part begins at a place, and goes on by steps, which are shorter to write.
  [[nodiscard]] std::string path_of(const std::vector<Point>& points) const {
    std::string data;
    long last_x = 0;
    long last_y = 0;
    bool pen_down = false;
    bool is_first_step = false;
    for (const Point& point : points) {
      if (!has_place(point)) {
        pen_down = false;
        continue;
      }
      const long x = std::lround(10.0 * x_of(point.x));
      const long y = std::lround(10.0 * y_of(point.y));
      if (pen_down && x == last_x && y == last_y) continue;
      if (!pen_down) {
        data += "M" + tenths(x, false) + tenths(y, true);
      } else {
        if (is_first_step) data += "l";
        data += tenths(x - last_x, !is_first_step) + tenths(y - last_y, true);
      }
      is_first_step = !pen_down;
      pen_down = true;
      last_x = x;
      last_y = y;
    }
    return data;
  }

  /// Returns as many ticks as fit without overlapping.
  [[nodiscard]] std::vector<Tick> ticks_below() const {
    std::vector<Tick> ticks = ticks_of(x_);
    std::size_t longest = 0;
    for (const Tick& tick : ticks) longest = std::max(longest, tick.text.size());
    const int room = static_cast<int>(width_ / (kDigit * static_cast<double>(longest) + kBetween));
    const bool is_crowded = x_.scale == Scale::Linear && static_cast<int>(ticks.size()) > room;
    return is_crowded ? ticks_of(x_, std::max(1, room - 1)) : ticks;
  }

  void draw_grid() {
    std::string grid;
    for (const Tick& tick : panel_.x.label.empty() ? std::vector<Tick>{} : ticks_below()) {
      const double x = x_of(tick.value);
      grid += fmt::format("M{:.1f} {:.1f}V{:.1f}", x, top_, bottom_);
      if (tick.text.empty()) continue;
      const double half = 0.5 * kWidestDigit * letters_in(tick.text);
      const double inside = std::min(x, kLeft + width_ + kRight - half);  // of the picture, at the end of the axis
      drawing_.text(inside, bottom_ + 17.0, tick.text, "value", " text-anchor=\"middle\"");
    }
    const int most_steps = std::clamp(static_cast<int>(panel_.height_px / kLeastStep), 3, 8);
    for (const Tick& tick : panel_.y.label.empty() ? std::vector<Tick>{} : ticks_of(y_, most_steps)) {
      const double y = y_of(tick.value);
      grid += fmt::format("M{:.1f} {:.1f}H{:.1f}", kLeft, y, kLeft + width_);
      if (!tick.text.empty()) drawing_.text(kLeft - 7.0, y + 4.0, tick.text, "value", " text-anchor=\"end\"");
    }
    drawing_.path(grid, "class=\"grid\"");
    drawing_.box(kLeft, top_, width_, panel_.height_px, "class=\"axes\"");
    drawing_.text(kLeft + 0.5 * width_, bottom_ + 38.0, panel_.x.label, "label", " text-anchor=\"middle\"");
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
    const std::string colour = drawing_.name_of(note.colour);
    if (note.distance_px > 0.0) {
      drawing_.line(x, y, end_x, end_y, fmt::format("stroke=\"{}\" stroke-width=\"0.8\"", colour));
    }
    const double side = std::cos(angle);
    const char* anchor = note.distance_px < 0.0 || std::abs(side) < 0.3 ? "middle" : side > 0.0 ? "start" : "end";
    const double room = std::abs(side) < 0.3 ? 0.0 : side > 0.0 ? 4.0 : -4.0;
    const double drop = std::abs(side) < 0.3 ? (std::sin(angle) > 0.0 ? 13.0 : -4.0) : 4.0;
    drawing_.text(end_x + room, end_y + drop, note.text, "note",
                  fmt::format(" text-anchor=\"{}\" style=\"fill:{}\"", anchor, colour));
  }

  Drawing& drawing_;
  const Panel& panel_;
  double width_;
  Axis x_;
  Axis y_;
  double top_;
  double bottom_;
  std::string id_;
};

constexpr const char* kStyle =
    "<style>text{font-family:Helvetica,Arial,sans-serif;fill:#222}.title{font-size:16px;font-weight:bold}"
    ".remark{font-size:12px}.label{font-size:13px}.value{font-size:12px}.note{font-size:12px}"
    ".grid{fill:none;stroke:#DDD;stroke-width:0.7}.axes{fill:none;stroke:#444}</style>\n";

/// Panels from top to bottom; returns where they end.
double draw_panels(Drawing& drawing, const Chart& chart, double top, const std::string& id) {
  for (std::size_t i = 0; i < chart.panels.size(); ++i) {
    const Panel& panel = chart.panels[i];
    top += legend_height_px(panel, chart.width_px);
    PanelDrawing(drawing, panel, chart.width_px, top, id).draw(i);
    top += panel.height_px + kAxisRoom;
  }
  return top;
}

/// The patterns of hatched areas, where the chart has any.
std::string hatches_of(const Drawing& drawing, const Chart& chart, const std::string& id) {
  const auto is_hatched = [](const Area& area) { return area.fill == Fill::Hatched; };
  const bool has_any = std::ranges::any_of(
      chart.panels, [&](const Panel& panel) { return std::ranges::any_of(panel.areas, is_hatched); });
  return has_any ? drawing.hatches(id) : std::string();
}

double picture_width(const Chart& chart) {
  return kLeft + chart.width_px + kRight;
}

}  // namespace

std::string to_svg(const Chart& chart) {
  Drawing drawing(Palette::File);
  double y = 24.0;
  drawing.text(kLeft, y, chart.title, "title");
  for (const std::string& remark : chart.remarks) drawing.text(kLeft, y += kLineHeight_px, remark, "remark");
  y = draw_panels(drawing, chart, y + 14.0, "");
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
             "{1:.0f}\">\n",
             picture_width(chart), y) +
         kStyle + hatches_of(drawing, chart, "") + "<rect width=\"100%\" height=\"100%\" fill=\"#FFF\"/>\n" +
         drawing.svg() + "</svg>\n";
}

std::string to_page_svg(const Chart& chart, const PagePlace& place) {
  Drawing drawing(Palette::Page);
  const std::string id = place.id + "-";
  const double height = draw_panels(drawing, chart, 8.0, id);
  return fmt::format("<svg class=\"chart\" id=\"{}\" role=\"img\" aria-label=\"{}\" viewBox=\"0 0 {:.0f} {:.0f}\">\n",
                     place.id, escaped(place.label), picture_width(chart), height) +
         hatches_of(drawing, chart, id) + drawing.svg() + "</svg>\n";
}

}  // namespace slipfit::chart
