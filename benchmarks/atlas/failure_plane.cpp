#include "failure_plane.hpp"

#include <array>
#include <cmath>

namespace atlas {
namespace {

struct Kind {
  Mark mark;
  chart::Colour colour;
  chart::Shape shape;
  const char* meaning;
};

constexpr std::array<Kind, 6> kKinds{
    {{Mark::Silent, chart::Colour::Grey, chart::Shape::Dot, "grey dot: says that it has no answer"},
     {Mark::Doubtful, chart::Colour::SkyBlue, chart::Shape::Ring, "blue ring: answers, and calls the answer weak"},
     {Mark::Wrong, chart::Colour::Vermillion, chart::Shape::Cross, "red cross: a wrong number without a warning"},
     {Mark::Multiple, chart::Colour::Purple, chart::Shape::Triangle,
      "purple triangle: a multiple, a part or the mains' frequency instead, without a warning"},
     {Mark::Missed, chart::Colour::Orange, chart::Shape::Ring, "orange ring: \"no stick-slip\" where there is"},
     {Mark::Invented, chart::Colour::Purple, chart::Shape::Triangle, "purple triangle: a cycle where there is none"}}};

chart::Axis axis_around(const PlaneAxis& axis) {
  const double step = std::sqrt(axis.values[1] / axis.values[0]);
  return {axis.label, axis.values.front() / step, axis.values.back() * step, chart::Scale::Logarithmic};
}

}  // namespace

chart::Panel draw_plane(const Plane& plane, const std::string& method, const Judge& judge) {
  chart::Panel panel;
  panel.height_px = plane.height_px;
  panel.x = axis_around(plane.x);
  panel.x.label = method + ":  " + panel.x.label;
  panel.y = axis_around(plane.y);
  panel.lines = plane.lines;
  for (const Kind& kind : kKinds) panel.markers.push_back({"", kind.colour, kind.shape, {}});
  bool all_fine = true;
  for (const double x : plane.x.values) {
    for (const double y : plane.y.values) {
      const Mark mark = judge(x, y);
      if (mark != Mark::Fine) all_fine = false;
      for (std::size_t i = 0; i < kKinds.size(); ++i) {
        if (kKinds[i].mark == mark) panel.markers[i].points.push_back({x, y});
      }
    }
  }
  const chart::Point middle{std::sqrt(panel.x.low * panel.x.high), std::sqrt(panel.y.low * panel.y.high)};
  if (all_fine) panel.notes.push_back({middle, "right at every point asked", chart::Colour::Black, 0.0, -1.0});
  return panel;
}

std::vector<std::string> explain_marks(const std::vector<Mark>& marks) {
  std::vector<std::string> lines;
  for (const Mark mark : marks) {
    for (const Kind& kind : kKinds) {
      if (kind.mark == mark) lines.emplace_back(kind.meaning);
    }
  }
  lines.emplace_back("no mark: right");
  return lines;
}

std::vector<File> map_failures(Effort effort) {
  std::vector<File> files;
  for (const auto& part : {map_forward_failures(effort), map_frequency_failures(effort), map_fit_failures(effort)}) {
    files.insert(files.end(), part.begin(), part.end());
  }
  return files;
}

}  // namespace atlas
