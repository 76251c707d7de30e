// The map of regimes over lambda and zeta (no figure of the paper): exact, and what the paper says.

#include "chart/chart.hpp"
#include "figures/parts.hpp"

namespace slipfit::figures {
namespace {

using chart::Colour, chart::Fill, chart::Point, chart::Shape, chart::Stroke;

constexpr chart::Scale kLog = chart::Scale::Logarithmic;
constexpr double kLeft = 0.01, kRight = 100.0;  // lambda
constexpr double kBottom = 0.001, kTop = 3.0;   // zeta

/// The limits by damping ratio, from the smallest to just below 1.
Table limits() {
  constexpr double kLargestZeta = 0.995;
  Table table(
      {"limits of stick-slip over lambda and zeta: exact, the paper's eq. (39), and the first lambda at which the "
       "paper's eq. (36) has a root"},
      {"damping_ratio", "lambda_limit_exact", "sticking_degree_at_exact_limit", "lambda_limit_of_eq_39",
       "lambda_first_root_of_eq_36"});
  for (const double zeta : logarithmically_spaced(kBottom, kLargestZeta, 150)) {
    table.add({zeta, critical_lambda(zeta), sticking_degree_at_limit(zeta), zeta, first_solvable_lambda(zeta)});
  }
  return table;
}

/// Between the left edge and a limit, below zeta = 1.
std::vector<Point> left_of(const chart::Line& limit) {
  std::vector<Point> outline{{kLeft, kBottom}};
  outline.insert(outline.end(), limit.points.begin(), limit.points.end());
  outline.insert(outline.end(), {{limit.points.back().x, 1.0}, {kLeft, 1.0}});
  return outline;
}

/// Between a limit and the right edge, below zeta = 1.
std::vector<Point> right_of(const chart::Line& limit) {
  std::vector<Point> outline = limit.points;
  outline.push_back({kRight, kBottom});
  return outline;
}

chart::Panel map_of(const Table& limits) {
  const chart::Line exact_limit = limits.line({"exact limit of stick-slip", Colour::Black, Stroke::Solid, {}}, 1, 0);
  const chart::Line first_root = limits.line({"limit of eq. (36)", Colour::Purple, Stroke::DashDotted, {}}, 4, 0);
  chart::Panel panel{
      .x = {"stick-slip parameter λ = ωₙ (Fₛ − Fₖ) / (k V)  [-]", kLeft, kRight, kLog},
      .y = {"damping ratio ζ  [-]", kBottom, kTop, kLog},
      .height_px = 420.0,
      .lines = {first_root,
                {"the paper's limit, ζ ≈ λ (eq. 39)", Colour::Vermillion, Stroke::Dashed, {{kLeft, kLeft}, {1.0, 1.0}}},
                exact_limit}};
  panel.areas = {{"", Colour::SkyBlue, Fill::Plain, right_of(exact_limit)},
                 {"", Colour::Grey, Fill::Plain, {{kLeft, 1}, {kLeft, kTop}, {kRight, kTop}, {kRight, 1}}},
                 {"left of it: eq. (36) has no solution", Colour::Purple, Fill::Hatched, left_of(first_root)}};
  chart::Markers printed{"limits printed in the paper (figure 7)", Colour::Vermillion, Shape::Triangle, {}};
  chart::Markers exact{"exact limits at the same ζ", Colour::Black, Shape::Dot, {}};
  for (const PrintedLimit& limit : kPrintedLimits) {
    printed.points.push_back({limit.lambda, limit.damping_ratio});
    exact.points.push_back({critical_lambda(limit.damping_ratio), limit.damping_ratio});
  }
  panel.markers = {exact, printed};
  panel.notes = {{{10.0, 0.12}, "stick-slip from rest (bistable)", Colour::Black, 0.0, -1.0},
                 {{0.04, 0.3}, "oscillatory slip", Colour::Black, 0.0, -1.0},
                 {{1.0, 1.7}, "continuous slip (ζ ≥ 1)", Colour::Black, 0.0, -1.0}};
  return panel;
}

}  // namespace

std::vector<FigureFile> regime_map() {
  const Table found = limits();
  return files_of("regime_map", found,
                  {"Stability map, Coulomb friction",
                   {"Between the dashed and the dash-dotted line the paper expects stick-slip,",
                    "but its equations have no solution there."},
                   {map_of(found)}});
}

}  // namespace slipfit::figures
