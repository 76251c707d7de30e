#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <optional>
#include <regex>
#include <set>
#include <stdexcept>

#include "chart/chart.hpp"
#include "chart/svg.hpp"
#include "run_program.hpp"
#include "slipfit/figures/figures.hpp"
#include "tables.hpp"

namespace chart = slipfit::chart;

namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Exit code of Python's XML parser over files, nothing where there is no Python.
std::optional<int> parse_xml(const std::vector<std::string>& files) {
  std::vector<std::string> arguments{"-c", "import sys, xml.dom.minidom as x; [x.parse(f) for f in sys.argv[1:]]"};
  arguments.insert(arguments.end(), files.begin(), files.end());
  try {
    return test::run_program("python3", arguments).exit_code;
  } catch (const std::runtime_error&) {
    WARN("skipped: no python3");
    return std::nullopt;
  }
}

}  // namespace

TEST_CASE("pictures are well-formed XML, small, and the same bytes twice") {
  const test::TemporaryFolder folder;
  const auto files = slipfit::paper_figures();
  const auto again = slipfit::paper_figures();
  std::vector<std::string> pictures;
  REQUIRE(files.size() == again.size());
  for (std::size_t i = 0; i < files.size(); ++i) {
    CAPTURE(files[i].name);
    CHECK(files[i].name == again[i].name);
    CHECK(files[i].content == again[i].content);
    CHECK(files[i].content.size() < 200'000);
    CHECK_FALSE(std::regex_search(files[i].content, std::regex(R"(\b(nan|inf)\b)")));
    if (has(files[i].name, ".svg")) pictures.push_back(folder.file(files[i].name, files[i].content));
  }
  CHECK(pictures.size() == 8);
  if (const auto exit_code = parse_xml(pictures)) CHECK(*exit_code == 0);
}

TEST_CASE("an outline that reaches 0 or below stays closed on a logarithmic axis") {
  chart::Panel panel;
  panel.x = {"speed", 1.0, 10.0, chart::Scale::Logarithmic};
  panel.y = {"spacing", 1.0, 10.0, chart::Scale::Logarithmic};
  panel.areas.push_back(
      {"band", chart::Colour::Blue, chart::Fill::Plain, {{1, 2}, {2, 0}, {5, -1}, {10, 2}, {10, 4}, {1, 4}}});
  const std::string svg = chart::to_svg({"", {}, {panel}});
  const std::size_t begin = svg.find("<path d=\"M", svg.find("clip-path"));
  REQUIRE(begin != std::string::npos);
  const std::string path = svg.substr(begin + 9, svg.find('"', begin + 9) - begin - 9);
  CHECK(std::count(path.begin(), path.end(), 'M') == 1);
  const std::regex number(R"(-?\d*\.?\d+)");
  CHECK(std::distance(std::sregex_iterator(path.begin(), path.end(), number), std::sregex_iterator()) == 2 * 6);
}

TEST_CASE("pictures state which values are assumed") {
  for (const std::string figure : {"figure_4", "figure_5", "figure_6", "figure_8"}) {
    CAPTURE(figure);
    CHECK(has(test::figure_file(figure + ".svg"), "Assumed: "));
    CHECK(has(test::figure_file(figure + ".csv"), "# assumed: "));
    CHECK(has(test::figure_file(figure + ".csv"), "\nassumed_"));
  }
}

TEST_CASE("text stays text, with what XML reserves escaped") {
  chart::Panel panel;
  panel.x.label = "a < b & c";
  panel.lines = {{"name", chart::Colour::Blue, chart::Stroke::Solid, {{0.0, 0.0}, {1.0, 1.0}}}};
  const std::string svg = chart::to_svg({"title", {"remark"}, {panel}});
  CHECK(has(svg, "a &lt; b &amp; c</text>"));
  for (const std::string text : {">title</text>", ">remark</text>", ">name</text>"}) CHECK(has(svg, text));
}

TEST_CASE("ticks are round numbers inside the axis") {
  const auto texts = [](const chart::Axis& axis) {
    std::string joined;
    for (const chart::Tick& tick : chart::ticks_of(axis)) joined += tick.text.empty() ? "." : " " + tick.text;
    return joined;
  };
  CHECK(texts({"", 0.0, 1.0, chart::Scale::Linear}) == " 0 0.2 0.4 0.6 0.8 1");
  CHECK(texts({"", -1.0, 8.0, chart::Scale::Linear}) == " 0 2 4 6 8");
  CHECK(texts({"", 0.0, 0.35, chart::Scale::Linear}) == " 0 0.05 0.1 0.15 0.2 0.25 0.3 0.35");
  CHECK(texts({"", 0.5, 60.0, chart::Scale::Logarithmic}) == "..... 1........ 10.....");
  CHECK(texts({"", 0.5, 30.0, chart::Scale::Logarithmic}) == " 0.5.... 1 2.. 5.... 10 20.");
  CHECK(texts({"", 3.0, 8.0, chart::Scale::Logarithmic}) == " 3 4 5 6 7 8");
  CHECK(texts({"", 1e-5, 1e-3, chart::Scale::Logarithmic}) ==
        " 10\u207B\u2075........ 10\u207B\u2074........ 10\u207B\u00B3");
  CHECK(texts({"", 1e6, 4e6, chart::Scale::Logarithmic}) ==
        " 10\u2076 2\u00D710\u2076 3\u00D710\u2076 4\u00D710\u2076");
}

TEST_CASE("the value at the right end of an axis is inside the picture") {
  chart::Panel panel;
  panel.x = {"x", 1e-3, 1e7, chart::Scale::Logarithmic};
  const std::string svg = chart::to_svg({"", {}, {panel}});
  std::smatch last;
  const std::string value = R"re(x="([0-9.]+)" y="[0-9.]+" class="value" text-anchor="middle">)re";
  REQUIRE(std::regex_search(svg, last, std::regex(value + "10\u2077<")));
  std::smatch width;
  REQUIRE(std::regex_search(svg, width, std::regex(R"re(width="([0-9]+)")re")));
  CHECK(std::stod(last[1]) + 0.5 * 6.6 * 3.0 <= std::stod(width[1]));
}

TEST_CASE("axes of every width are drawn: finite, with a bounded number of different ticks") {
  constexpr double kHuge = 1.7e308;
  struct Ends {
    double low, high;
  };
  const std::vector<Ends> ends = {{0.3, 0.1 + 0.2},    {1e15, 1e15 + 10.0},  {1e16, 1e16 + 2.0}, {0.0, 0.0},
                                  {5e-324, 1e-323},    {-kHuge, kHuge},      {kHuge, kHuge},     {1e-300, 1e300},
                                  {-5e-324, 5e-324},   {2.0, 1.0},           {-1.0, -1.0},       {1.7e9, 1.7e9 + 0.01},
                                  {0.0, std::nan("")}, {INFINITY, INFINITY}, {-INFINITY, 1.0},   {0.0, 5e-324}};
  for (const Ends& e : ends) {
    for (const chart::Scale scale : {chart::Scale::Linear, chart::Scale::Logarithmic}) {
      CAPTURE(e.low, e.high, scale == chart::Scale::Linear);
      const chart::Axis axis = chart::drawable({"x", e.low, e.high, scale});
      CHECK(std::isfinite(axis.high - axis.low));
      CHECK(axis.low < axis.high);
      const auto ticks = chart::ticks_of(axis);
      CHECK(ticks.size() <= 9 * 25);
      std::set<double> values;
      for (const chart::Tick& tick : ticks) values.insert(tick.value);
      CHECK(values.size() == ticks.size());
      chart::Chart picture;
      chart::Panel panel;
      panel.x = panel.y = {"x", e.low, e.high, scale};
      panel.lines.push_back({"line", chart::Colour::Blue, chart::Stroke::Solid, {{e.low, e.high}, {e.high, e.low}}});
      panel.markers.push_back({"points", chart::Colour::Blue, chart::Shape::Dot, {{e.low, e.low}, {INFINITY, NAN}}});
      panel.notes.push_back({{e.high, NAN}, "note"});
      picture.panels = {panel};
      const std::string svg = chart::to_svg(picture);
      CHECK(svg.size() < 60'000);
      CHECK_FALSE(std::regex_search(svg, std::regex(R"(\b(nan|inf)\b)")));
    }
  }
}

TEST_CASE("ticks of a narrow axis far from zero have enough digits to differ") {
  std::set<std::string> texts;
  const auto ticks = chart::ticks_of(chart::drawable({"time", 1e15, 1e15 + 20.0, chart::Scale::Linear}));
  for (const chart::Tick& tick : ticks) texts.insert(tick.text);
  CHECK(ticks.size() >= 5);
  CHECK(texts.size() == ticks.size());
}
