// Contrast of the pages by WCAG 2.1: 4.5:1 for text (1.4.3), 3:1 for marks (1.4.11), in light and dark.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "examples.hpp"
#include "report/batch_html.hpp"
#include "slipfit/report/html.hpp"
#include "slipfit/report/json.hpp"
#include "slipfit/report/sweep_html.hpp"

using namespace slipfit;

namespace {

using Colour = std::array<double, 3>;           // red, green, blue from 0 to 1
using Palette = std::map<std::string, Colour>;  // by the names of the style sheet's variables

constexpr double kText = 4.5;
constexpr double kMark = 3.0;

Colour colour_from(const std::string& hex) {
  const bool is_short = hex.size() == 3;
  Colour colour{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string digits = is_short ? std::string(2, hex[i]) : hex.substr(2 * i, 2);
    colour.at(i) = std::stoi(digits, nullptr, 16) / 255.0;
  }
  return colour;
}

double luminance(const Colour& colour) {
  const auto linear = [](double part) {
    return part <= 0.04045 ? part / 12.92 : std::pow((part + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(colour[0]) + 0.7152 * linear(colour[1]) + 0.0722 * linear(colour[2]);
}

double contrast(const Colour& a, const Colour& b) {
  const auto [dark, light] = std::minmax({luminance(a), luminance(b)});
  return (light + 0.05) / (dark + 0.05);
}

Colour laid_over(const Colour& upper, double opacity, const Colour& lower) {
  Colour mixed{};
  for (std::size_t i = 0; i < 3; ++i) mixed.at(i) = opacity * upper.at(i) + (1.0 - opacity) * lower.at(i);
  return mixed;
}

std::vector<std::smatch> all_matches(const std::string& text, const std::regex& pattern) {
  return {std::sregex_iterator(text.begin(), text.end(), pattern), std::sregex_iterator()};
}

/// Of the style sheet in the page: the first block of variables is light, the second changes it to dark.
std::vector<Palette> palettes_in(const std::string& page) {
  static const std::regex kBlock(R"(:root \{([^}]*)\})");
  static const std::regex kVariable(R"(--([a-z-]+): #([0-9a-f]{6}|[0-9a-f]{3});)");
  std::vector<Palette> palettes;
  Palette palette;
  for (const std::smatch& block : all_matches(page, kBlock)) {
    const std::string variables = block[1];
    for (const std::smatch& variable : all_matches(variables, kVariable)) {
      palette[variable[1]] = colour_from(variable[2]);
    }
    palettes.push_back(palette);
  }
  return palettes;
}

/// Every coloured rule of the style sheet, against the page and against the wash of tables and code.
void check_rules(const std::string& page, const Palette& palette) {
  static const std::regex kRule(R"(([^{}]+)\{([^{}]*)\})");
  static const std::regex kColour(R"((^|[ ;{])(color|fill|stroke|border[a-z-]*):[^;]*var\(--([a-z-]+)\))");
  const std::string style = page.substr(page.find("* { box-sizing"), page.find("</style>") - page.find("* { box-"));
  for (const std::smatch& rule : all_matches(style, kRule)) {
    const std::string selector = rule[1];
    const std::string body = rule[2];
    const bool is_glyph = selector.find("::before") != std::string::npos || selector.find(".key") != std::string::npos;
    for (const std::smatch& found : all_matches(body, kColour)) {
      const std::string property = found[2];
      const std::string name = found[3];
      const bool is_decoration =
          name == "rule" || name == "chart-grid" || name == "chart-paper";  // nothing hangs on it
      if (is_decoration) continue;
      const bool is_text = (property == "color" && !is_glyph) || (property == "fill" && name == "ink");
      CAPTURE(selector, property, name);
      for (const char* const paper : {"paper", "wash"}) {
        CHECK(contrast(palette.at(name), palette.at(paper)) >= (is_text ? kText : kMark));
      }
    }
  }
}

/// The elements of a chart that draw, without the points of their paths.
std::vector<std::string> elements_of(const std::string& chart) {
  std::vector<std::string> elements;
  for (std::size_t begin = chart.find('<'); begin != std::string::npos; begin = chart.find('<', begin + 1)) {
    std::string element = chart.substr(begin, chart.find('>', begin) - begin);
    if (const std::size_t data = element.find(" d=\""); data != std::string::npos) {
      element.erase(data, element.find('"', data + 4) + 1 - data);
    }
    elements.push_back(std::move(element));
  }
  return elements;
}

/// Every element of a chart that is drawn in a colour of the palette. A shade counts by its edge where it has one.
std::size_t check_marks(const std::string& chart, const Palette& palette) {
  static const std::regex kFill(R"re(fill[:=]"?var\(--([a-z-]+)\)"?(?: fill-opacity="([0-9.]+)")?)re");
  static const std::regex kStroke(R"re(stroke="var\(--([a-z-]+)\)")re");
  std::size_t marks = 0;
  for (const std::string& element : elements_of(chart)) {
    std::smatch colour;
    const bool has_stroke = std::regex_search(element, colour, kStroke);
    if (!has_stroke && !std::regex_search(element, colour, kFill)) continue;
    const bool has_opacity = !has_stroke && colour[2].matched;
    const double opacity = has_opacity ? std::stod(colour[2]) : 1.0;
    const Colour& paper = palette.at("chart-paper");
    CAPTURE(element);
    CHECK(contrast(laid_over(palette.at(colour[1]), opacity, paper), paper) >=
          (element.starts_with("<text") ? kText : kMark));
    ++marks;
  }
  return marks;
}

/// Marks of all charts but the picture of the pattern, whose shades are the ridges of the surface.
std::size_t check_charts(const std::string& page, const Palette& palette) {
  std::size_t marks = 0;
  for (std::size_t begin = 0; (begin = page.find("<svg", begin)) != std::string::npos;) {
    const std::size_t end = page.find("</svg>", begin);
    const std::string chart = page.substr(begin, end - begin);
    if (chart.find("id=\"pattern\"") == std::string::npos) marks += check_marks(chart, palette);
    begin = end;
  }
  return marks;
}

std::string page_of_recording() {
  const Recording recording = test::stick_slip_recording(0.01);
  FitOptions options;
  options.curve = true;
  const Analysis analysis = analyze_and_fit(recording, options);
  return to_html(recording, analysis, gather_background(recording, analysis), {"slipfit fit run.csv"});
}

std::string page_of_sweep() {
  std::vector<SweepEntry> entries;
  for (const double speed : {0.005, 0.01, 0.02}) entries.push_back({"run", test::stick_slip_recording(speed)});
  const SweepAnalysis sweep = analyze_sweep(entries);
  return to_html(entries, sweep, predict_around(entries, sweep), {"dry", {}});
}

std::string page_of_batch() {
  JsonOptions options;
  options.id = "run";
  options.layout = JsonLayout::OneLine;
  BatchPage batch{"batch", {}, {}};
  for (int i = 0; i < 6; ++i) {
    batch.rows.push_back(batch_page_row(to_json(test::small_recording(), test::full_analysis(), options)).value());
  }
  return to_html(batch);
}

}  // namespace

TEST_CASE("text has a contrast of 4.5:1 and marks have 3:1, on light and dark pages") {
  const std::vector<std::string> pages{page_of_recording(), page_of_sweep(), page_of_batch()};
  const auto palettes = palettes_in(pages.front());
  REQUIRE(palettes.size() == 2);
  for (const Palette& palette : palettes) {
    CAPTURE(&palette == &palettes.front() ? "light" : "dark");
    check_rules(pages.front(), palette);
    for (const std::string& page : pages) CHECK(check_charts(page, palette) > 0);
  }
}

TEST_CASE("lines and marks of a chart that is a file of its own have 3:1 on white") {
  const Recording recording = test::stick_slip_recording(0.01);
  const Analysis analysis = analyze_and_fit(recording);
  static const std::regex kStroke(R"(stroke="#([0-9A-F]{6})\")");
  std::size_t lines = 0;
  for (const PictureFile& picture : report_pictures(recording, analysis, gather_background(recording, analysis))) {
    CAPTURE(picture.name);
    for (const std::smatch& stroke : all_matches(picture.content, kStroke)) {
      CAPTURE(stroke[1].str());
      CHECK(contrast(colour_from(stroke[1]), {1.0, 1.0, 1.0}) >= kMark);
      ++lines;
    }
  }
  CHECK(lines > 10);
}
