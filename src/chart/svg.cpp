#include "chart/svg.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <limits>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "chart/chart.hpp"

namespace slipfit::chart {

namespace {

struct ColourName {
  const char* value;
  const char* variable;  ///< of the page's style sheet
};

// In the order of Colour, Stroke. Values as on a light page: at least 3:1 against white.
constexpr std::array<ColourName, 9> kColours{{{"#000000", "black"},
                                              {"#C07F00", "orange"},
                                              {"#2F93CF", "sky"},
                                              {"#009E73", "green"},
                                              {"#9A9000", "yellow"},
                                              {"#0072B2", "blue"},
                                              {"#D55E00", "vermillion"},
                                              {"#C2659A", "purple"},
                                              {"#6F6F6F", "grey"}}};
constexpr std::array kDashes{"", "8 4", "2 3", "10 3 2 3"};

template <class Choice>
std::size_t index_of(Choice choice) {
  return static_cast<std::size_t>(choice);
}

}  // namespace

std::string escaped(const std::string& text) {
  constexpr std::string_view kSpecial = "&<>\"'";
  constexpr std::array kEscapes{"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"};
  std::string result;
  for (const char c : text) {
    const std::size_t special = kSpecial.find(c);
    special == std::string_view::npos ? result.push_back(c) : void(result += kEscapes.at(special));
  }
  return result;
}

double letters_in(const std::string& text) {
  const auto begins_letter = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; };
  return static_cast<double>(std::ranges::count_if(text, begins_letter));
}

void Drawing::text(double x, double y, const std::string& content, const char* css_class, const std::string& more) {
  fmt::format_to(std::back_inserter(svg_), "<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"{}\"{}>{}</text>\n", x, y,
                 css_class, more, escaped(content));
}

void Drawing::line(double x1, double y1, double x2, double y2, const std::string& style) {
  fmt::format_to(std::back_inserter(svg_), "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", x1,
                 y1, x2, y2, style);
}

void Drawing::box(double x, double y, double width, double height, const std::string& style) {
  fmt::format_to(std::back_inserter(svg_), "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" {}/>\n",
                 x, y, width, height, style);
}

void Drawing::path(const std::string& data, const std::string& style) {
  fmt::format_to(std::back_inserter(svg_), "<path d=\"{}\" {}/>\n", data, style);
}

void Drawing::markers(const std::vector<Point>& places, Colour colour, Shape shape, const std::string& attributes) {
  constexpr const char* kRound = "M-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0z";
  const std::string name = name_of(colour);
  const auto filled = [&name](const char* opacity) { return fmt::format("fill=\"{}\"{}", name, opacity); };
  const std::string ring = fmt::format("fill=\"{}\" stroke=\"{}\" stroke-width=\"2\"",
                                       palette_ == Palette::File ? "#FFF" : "var(--chart-paper)", name);
  struct Look {
    const char* outline;
    std::string style;
  };
  // In the order of Shape.
  const std::array<Look, 5> looks{{{kRound, filled("")},
                                   {"M-2 0a2 2 0 1 0 4 0a2 2 0 1 0 -4 0z", filled(" fill-opacity=\"0.8\"")},
                                   {kRound, ring},
                                   {"M0 -5 5 4 -5 4z", ring},
                                   {"M-4 -4 4 4M-4 4 4 -4", fmt::format("stroke=\"{}\" stroke-width=\"2.4\"", name)}}};
  const Look& look = looks.at(index_of(shape));
  raw(fmt::format("<g {}{}>\n", look.style, attributes));
  for (const Point& place : places)
    path(look.outline, fmt::format("transform=\"translate({:.1f} {:.1f})\"", place.x, place.y));
  raw("</g>\n");
}

std::string Drawing::name_of(Colour colour) const {
  const ColourName& name = kColours.at(index_of(colour));
  return palette_ == Palette::File ? name.value : fmt::format("var(--chart-{})", name.variable);
}

std::string Drawing::stroke_style(const Line& line) const {
  const char* dashes = kDashes.at(index_of(line.stroke));
  return fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"{}", name_of(line.colour), line.width_px,
                     *dashes == '\0' ? "" : fmt::format(" stroke-dasharray=\"{}\"", dashes));
}

std::string Drawing::area_style(const Area& area, const std::string& id) const {
  if (area.fill == Fill::Hatched) return fmt::format("fill=\"url(#{}hatch{})\"", id, index_of(area.colour));
  const std::string name = name_of(area.colour);
  const std::string edge =
      area.edge_px > 0.0 ? fmt::format(" stroke=\"{}\" stroke-width=\"{}\"", name, area.edge_px) : std::string();
  return fmt::format("fill=\"{}\" fill-opacity=\"0.3\"{}", name, edge);
}

std::string Drawing::hatches(const std::string& id) const {
  std::string patterns = "<defs>\n";
  for (std::size_t i = 0; i < kColours.size(); ++i) {
    patterns += fmt::format(
        "<pattern id=\"{}hatch{}\" width=\"8\" height=\"8\" patternUnits=\"userSpaceOnUse\" "
        "patternTransform=\"rotate(40)\">"
        "<path d=\"M0 0V8\" stroke=\"{}\" stroke-width=\"2\"/></pattern>\n",
        id, i, name_of(static_cast<Colour>(i)));
  }
  return patterns + "</defs>\n";
}

namespace {

// Pixels.
constexpr double kLineHeight = 18.0;
constexpr double kCharacter = 6.6;  // mean width of a letter at 12 px
constexpr double kSample = 26.0;    // length of a line in the legend
constexpr double kGap = 22.0;       // between two entries in a row

struct Spot {
  double x = 0.0;
  double y = 0.0;
};

struct Entry {
  std::string name;
  std::function<void(Drawing&, Spot)> draw_sample;  ///< with the left end of the sample, in the middle of the row

  [[nodiscard]] double width() const { return kSample + kGap + kCharacter * letters_in(name); }
};

/// `id` is that of the picture.
std::vector<Entry> entries_of(const Panel& panel, const std::string& id) {
  std::vector<Entry> entries;
  if (panel.legend_at == LegendAt::None) return entries;
  for (const Line& line : panel.lines) {
    entries.push_back({line.name, [&line](Drawing& drawing, Spot at) {
                         drawing.line(at.x, at.y, at.x + kSample, at.y, drawing.stroke_style(line));
                       }});
  }
  for (const Markers& markers : panel.markers) {
    entries.push_back({markers.name, [&markers](Drawing& drawing, Spot at) {
                         drawing.markers({{at.x + 0.5 * kSample, at.y}}, markers.colour, markers.shape);
                       }});
  }
  for (const Area& area : panel.areas) {
    entries.push_back({area.name, [&area, &id](Drawing& drawing, Spot at) {
                         drawing.box(at.x, at.y - 6.0, kSample, 12.0, drawing.area_style(area, id));
                       }});
  }
  std::erase_if(entries, [](const Entry& entry) { return entry.name.empty(); });
  return entries;
}

/// Returns the position of each entry of a legend above the axes, from the upper left corner; a full row starts another
/// one.
std::vector<Spot> rows_of(const std::vector<Entry>& entries, double width_px) {
  std::vector<Spot> spots;
  Spot next;
  for (const Entry& entry : entries) {
    if (next.x > 0.0 && next.x + entry.width() - kGap > width_px) next = {0.0, next.y + kLineHeight};
    spots.push_back(next);
    next.x += entry.width();
  }
  return spots;
}

/// The room inside the axes of a panel, in pixels.
struct Frame {
  double left = 0.0;
  double top = 0.0;
  double width = 0.0;
  double height = 0.0;
};

/// Room that the legend takes above the axes; 0 without one.
double legend_height_px(const Panel& panel, double width_px) {
  const std::vector<Entry> entries = entries_of(panel, {});
  if (entries.empty()) return 0.0;
  return rows_of(entries, width_px).back().y + kLineHeight + 6.0;
}

/// Draws the entries of everything with a name, in the order lines, markers, areas. `id` is that of the picture.
void draw_legend(Drawing& drawing, const Panel& panel, const Frame& frame, const std::string& id) {
  const std::vector<Entry> entries = entries_of(panel, id);
  if (entries.empty()) return;
  const double top = frame.top - legend_height_px(panel, frame.width) + 0.5 * kLineHeight;
  const std::vector<Spot> spots = rows_of(entries, frame.width);
  drawing.raw("<g class=\"entries\">\n");
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const Spot spot{frame.left + spots[i].x, top + spots[i].y};
    drawing.text(spot.x + kSample + 7.0, spot.y + 4.0, entries[i].name, "value");
    entries[i].draw_sample(drawing, spot);
  }
  drawing.raw("</g>\n");
}

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
    const double end_x = x + std::abs(note.distance_px) * std::cos(angle);
    const double end_y = y + std::abs(note.distance_px) * std::sin(angle);
    const std::string colour = drawing_.name_of(note.colour);
    const bool is_beside = note.distance_px > 0.0;
    if (is_beside) drawing_.line(x, y, end_x, end_y, fmt::format("stroke=\"{}\" stroke-width=\"0.8\"", colour));
    drawing_.text(end_x + 4.0, end_y + 4.0, note.text, "note",
                  fmt::format(" text-anchor=\"{}\" style=\"fill:{}\"", is_beside ? "start" : "middle", colour));
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
  for (const std::string& remark : chart.remarks) drawing.text(kLeft, y += kLineHeight, remark, "remark");
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

std::string to_page_legend(const Chart& chart, const std::string& id) {
  constexpr double kHeight = 14.0;
  std::string rows;
  std::vector<std::string> names;
  for (const Panel& panel : chart.panels) {
    if (panel.legend_at != LegendAt::Above) continue;
    const std::string prefix = id + "-";
    for (const Entry& entry : entries_of(panel, prefix)) {
      if (std::ranges::find(names, entry.name) != names.end()) continue;
      if (&panel != &chart.panels.front()) return {};
      names.push_back(entry.name);
      Drawing sample(Palette::Page);
      entry.draw_sample(sample, {0.0, 0.5 * kHeight});
      rows += fmt::format("<li><svg width=\"{0:.0f}\" height=\"{1:.0f}\" aria-hidden=\"true\">{2}</svg>{3}</li>\n",
                          kSample, kHeight, sample.svg(), escaped(entry.name));
    }
  }
  return rows.empty() ? rows : "<ul class=\"legend-list\">\n" + rows + "</ul>\n";
}

namespace {

constexpr double kSlack = 1e-9;  // of a step: a tick on the end of the axis counts in spite of rounding

double step_for(double range, int most_steps) {
  const double power = std::pow(10.0, std::floor(std::log10(range / most_steps)));
  for (const double step : {power, 2.0 * power, 5.0 * power}) {
    if (range / step <= most_steps + kSlack) return step;
  }
  return 10.0 * power;
}

/// Power of ten of the first digit.
double exponent_of(double value) {
  return std::floor(std::log10(std::abs(value)));
}

/// Writes a tick with enough digits to differ from its neighbours: a clock of the year 1970 needs ten before the
/// decimal point.
std::string text_of(double value, double step) {
  constexpr double kFew = 6.0;
  constexpr double kMost = 16.0;  // that a double has
  const double digits = value == 0.0 ? kFew : exponent_of(value) - exponent_of(step) + 1.0;
  return fmt::format("{:.{}g}", value, static_cast<int>(std::clamp(digits, kFew, kMost)));
}

std::vector<Tick> linear_ticks(const Axis& axis, int most_steps) {
  const double step = step_for(axis.high - axis.low, most_steps);
  const double first = std::ceil(axis.low / step - kSlack);
  std::vector<Tick> ticks;
  for (int i = 0; i <= most_steps; ++i) {
    const double value = (first + i) * step + 0.0;  // not -0
    if (value > axis.high + kSlack * step) break;
    ticks.push_back({value, text_of(value, step)});
  }
  constexpr int kClose = 8;  // a single value does not show the scale
  return ticks.size() < 2 && most_steps < kClose ? linear_ticks(axis, most_steps + 1) : ticks;
}

/// Decades carry values; on a short axis 2 and 5 of each decade too, on a very short one every part.
bool carries_value(const Axis& axis, int part) {
  const double decades = std::log10(axis.high / axis.low);
  return part == 1 || decades < 0.7 || (decades < 2.0 && (part == 2 || part == 5));
}

/// 10 to the power of `decade`, times `part` unless that is 1.
std::string power_of_ten(int part, int decade) {
  constexpr std::array kRaised{"\u2070", "\u00B9", "\u00B2", "\u00B3", "\u2074",
                               "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  std::string text = part == 1 ? "10" : fmt::format("{}\u00D710", part);
  for (const char c : std::to_string(decade))
    text += c == '-' ? "\u207B" : kRaised.at(static_cast<std::size_t>(c - '0'));
  return text;
}

std::vector<Tick> logarithmic_ticks(const Axis& axis) {
  constexpr int kMostDecades = 24;  // beyond them some decades represent all
  const int first = static_cast<int>(std::floor(std::log10(axis.low) + kSlack));
  const int last = static_cast<int>(std::floor(std::log10(axis.high) + kSlack));
  const int stride = 1 + (last - first) / kMostDecades;
  const bool is_plain = first >= -4 && last <= 5;  // no exponent in any of them
  std::vector<Tick> ticks;
  for (int decade = first; decade <= last; decade += stride) {
    for (int part = 1; part < (stride == 1 ? 10 : 2); ++part) {
      const double value = part * std::pow(10.0, decade);
      if (value < axis.low * (1.0 - kSlack) || value > axis.high * (1.0 + kSlack)) continue;
      const std::string text = is_plain ? fmt::format("{:.6g}", value) : power_of_ten(part, decade);
      ticks.push_back({value, carries_value(axis, part) ? text : std::string()});
    }
  }
  return ticks;
}

constexpr double kLargest = 1e300;  // differences and sums of two such numbers are finite
constexpr double kSmallest = 1e-300;

Axis drawable_linear(Axis axis) {
  constexpr double kLeastShare =
      64.0 * std::numeric_limits<double>::epsilon();  // eight doubles for each of eight steps
  const double least = std::max(kSmallest, kLeastShare * std::max(std::abs(axis.low), std::abs(axis.high)));
  if (axis.high - axis.low >= least) return axis;
  const double middle = axis.low + 0.5 * (axis.high - axis.low);
  axis.low = middle - 0.5 * least;
  axis.high = middle + 0.5 * least;
  return axis;
}

Axis drawable_logarithmic(Axis axis) {
  constexpr double kLeastRatio = 1.001;
  axis.low = std::max(axis.low, kSmallest);
  axis.high = std::max(axis.high, axis.low);
  if (axis.high >= kLeastRatio * axis.low) return axis;
  axis.low /= kLeastRatio;
  axis.high *= kLeastRatio;
  return axis;
}

}  // namespace

Axis drawable(Axis axis) {
  const bool is_linear = axis.scale == Scale::Linear;
  if (std::isnan(axis.low) || std::isnan(axis.high)) {
    axis.low = is_linear ? 0.0 : 1.0;
    axis.high = axis.low + 1.0;
  }
  if (axis.high < axis.low) std::swap(axis.low, axis.high);
  axis.low = std::clamp(axis.low, -kLargest, kLargest);
  axis.high = std::clamp(axis.high, -kLargest, kLargest);
  return is_linear ? drawable_linear(std::move(axis)) : drawable_logarithmic(std::move(axis));
}

std::vector<Tick> ticks_of(const Axis& axis, int most_steps) {
  return axis.scale == Scale::Linear ? linear_ticks(axis, most_steps) : logarithmic_ticks(axis);
}

}  // namespace slipfit::chart
