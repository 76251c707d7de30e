#pragma once

#include <string>
#include <vector>

#include "chart/chart.hpp"

namespace slipfit::chart {

/// Colours as they are, or as the variables --chart-black, --chart-blue, ... and --chart-paper of a page's style sheet.
enum class Palette { File, Page };

/// SVG elements, one after the other, in the colours of the place of the picture.
class Drawing {
 public:
  explicit Drawing(Palette palette) : palette_(palette) {}

  /// Draws text. `more` are further attributes, each with a leading blank.
  void text(double x, double y, const std::string& content, const char* css_class, const std::string& more = {});
  void line(double x1, double y1, double x2, double y2, const std::string& style);
  void box(double x, double y, double width, double height, const std::string& style);
  void path(const std::string& data, const std::string& style);
  /// Draws markers at these places, in pixels, as one element with these attributes, each with a leading blank.
  void markers(const std::vector<Point>& places, Colour colour, Shape shape, const std::string& attributes = {});
  void raw(const std::string& element) { svg_ += element; }

  [[nodiscard]] bool is_on_page() const { return palette_ == Palette::Page; }
  [[nodiscard]] const std::string& svg() const { return svg_; }
  [[nodiscard]] std::string name_of(Colour colour) const;
  [[nodiscard]] std::string stroke_style(const Line& line) const;
  /// Returns the style of an area. `id` is that of the picture and prefixes the names of its patterns.
  [[nodiscard]] std::string area_style(const Area& area, const std::string& id) const;
  /// The patterns that hatched areas name.
  [[nodiscard]] std::string hatches(const std::string& id) const;

 private:
  Palette palette_;
  std::string svg_;
};

/// Text from outside must stay text, in HTML and XML: & < > " ' escaped.
std::string escaped(const std::string& text);

/// Letters of a UTF-8 text, for the room that it takes.
double letters_in(const std::string& text);

struct Tick {
  double value = 0.0;
  std::string text;  ///< empty: a grid line only
};

/// The axis as it can be drawn: finite ends in order, positive ones on a logarithmic axis, and so far apart that ticks
/// between them are different doubles.
Axis drawable(Axis axis);

/// Returns the ticks of a drawable axis: steps of 1, 2 or 5 times a power of ten, at most `most_steps` of them; on a
/// logarithmic axis decades with their parts, all decades with values (some, if they are very many) and, if the axis is
/// short, some parts.
std::vector<Tick> ticks_of(const Axis& axis, int most_steps = 8);

}  // namespace slipfit::chart
