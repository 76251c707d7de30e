#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/html/exhibit.hpp"
#include "report/html/scaling.hpp"

namespace slipfit::html {
namespace {

using chart::Colour, chart::Point, chart::Stroke;

constexpr double kLowestZeta = 1e-3;
constexpr double kHighestZeta = 3.0;

/// The recording on the map; intervals as far as they are known.
struct Spot {
  Estimate lambda;
  Estimate zeta;
};

Spot spot_of(const Analysis& analysis) {
  Spot spot{analysis.derived.lambda, {}};
  if (!analysis.fit) return spot;
  const Parameter* const zeta = analysis.fit->find(ParameterId::DampingRatio);
  if (zeta != nullptr && zeta->status != ParameterStatus::Bounded) spot.zeta = zeta->estimate;
  return spot;
}

chart::Panel regions(const std::vector<LimitPoint>& limit, double left, double right) {
  chart::Panel panel;
  panel.height_px = 340.0;
  panel.legend_at = chart::LegendAt::Above;
  panel.x = {"stick-slip parameter λ = ωₙ (Fₛ − Fₖ) / (k V)  [-]", left, right, chart::Scale::Logarithmic};
  panel.y = {"damping ratio ζ  [-]", kLowestZeta, kHighestZeta, chart::Scale::Logarithmic};
  chart::Line exact{"exact limit of stick-slip", Colour::Black, Stroke::Solid, {}};
  for (const LimitPoint& point : limit) exact.points.push_back({point.lambda, point.damping_ratio});
  std::vector<Point> stick_slip = exact.points;
  stick_slip.push_back({right, 1.0});
  stick_slip.push_back({right, kLowestZeta});
  panel.areas = {
      {"", Colour::SkyBlue, chart::Fill::Plain, stick_slip},
      {"", Colour::Grey, chart::Fill::Plain, {{left, 1.0}, {left, kHighestZeta}, {right, kHighestZeta}, {right, 1.0}}}};
  panel.lines.push_back(exact);
  panel.notes = {{{left * std::pow(right / left, 0.8), 0.004}, "stick-slip", Colour::Black, 0.0, -1.0},
                 {{left * std::pow(right / left, 0.12), 0.3}, "no stick-slip", Colour::Black, 0.0, -1.0},
                 {{left * std::pow(right / left, 0.5), 1.6}, "overdamped, ζ ≥ 1", Colour::Black, 0.0, -1.0}};
  return panel;
}

/// Bars that reach over the 95 % intervals.
void add_spot(chart::Panel& panel, const Spot& spot) {
  const double lambda = *spot.lambda.value;
  const double zeta = std::max(*spot.zeta.value, kLowestZeta);
  panel.markers.push_back({"this recording", Colour::Vermillion, chart::Shape::Dot, {{lambda, zeta}}});
  const auto bar = [&panel](Point from, Point to) {
    const char* name = panel.lines.size() == 1 ? "95 % intervals" : "";
    panel.lines.push_back({name, Colour::Vermillion, Stroke::Solid, {from, to}, 2.4});
  };
  if (spot.lambda.ci95) bar({spot.lambda.ci95->low, zeta}, {spot.lambda.ci95->high, zeta});
  if (spot.zeta.ci95) {
    bar({lambda, std::max(spot.zeta.ci95->low, kLowestZeta)}, {lambda, std::max(spot.zeta.ci95->high, kLowestZeta)});
  }
}

}  // namespace

Exhibit map_exhibit(const Source& source) {
  Exhibit exhibit{"map", "Where this recording lies", {}, {}, {}, {}};
  exhibit.guide =
      "Right of the line a body that starts from rest keeps sticking and slipping, left of it the motion dies out. "
      "Raising the speed moves the point to the left (lambda falls as 1/V). The bars are the 95 % intervals; a damping "
      "ratio below 0.001 is drawn at the lower edge.";
  const Spot spot = spot_of(source.analysis);
  if (!spot.lambda.value || !spot.zeta.value || !(*spot.lambda.value > 0.0)) {
    const std::string& why = spot.lambda.value ? spot.zeta.note : spot.lambda.note;
    exhibit.absent = "The place on the map is not known" + (why.empty() ? std::string() : ": " + why) + ".";
    return exhibit;
  }
  const double lambda = *spot.lambda.value;
  chart::Panel panel = regions(source.background.limit, std::min(0.01, 0.3 * lambda), std::max(100.0, 3.0 * lambda));
  add_spot(panel, spot);
  exhibit.chart = chart::Chart{"Map of regimes", {}, {panel}};
  exhibit.label = fmt::format(
      "map of damping ratio against lambda with the limit of stick-slip; this recording lies at "
      "lambda {}, damping ratio {}",
      rounded(spot.lambda).value, rounded(spot.zeta).value);
  return exhibit;
}

}  // namespace slipfit::html
