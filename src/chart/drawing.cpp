#include "chart/drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <string_view>

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
  constexpr std::string_view kSpecial = "&<>\"";
  constexpr std::array kEscapes{"&amp;", "&lt;", "&gt;", "&quot;"};
  std::string result;
  for (const char c : text) {
    const std::size_t special = kSpecial.find(c);
    result += special == std::string_view::npos ? std::string(1, c) : kEscapes.at(special);
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

}  // namespace slipfit::chart
