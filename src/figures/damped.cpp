// Figure 7: the sticking degree with damping, the exact solution and the paper's, and the limits of both.

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "chart/chart.hpp"
#include "figures/parts.hpp"

namespace slipfit::figures {
namespace {

using chart::Colour, chart::Shape, chart::Stroke;

constexpr double kLargestDampedLambda = 6.0;
constexpr std::array<Colour, 3> kDampedColours{Colour::Blue, Colour::Vermillion, Colour::Green};

/// Denser towards the limits, where the curves are steep; both limits are among them.
std::vector<double> lambdas_from(double first, double critical) {
  std::vector<double> lambdas{critical};
  for (const double part : evenly_spaced(0.0, 1.0, 200)) {
    lambdas.push_back(first + (kLargestDampedLambda - first) * part * part);
  }
  std::ranges::sort(lambdas);
  return lambdas;
}

chart::Line undamped_curve(Table& table) {
  chart::Line line{"ζ = 0, eq. (22)", Colour::Black, Stroke::Solid, {{0.0, 0.0}}};
  for (const double lambda : evenly_spaced(0.0, kLargestDampedLambda, 200)) {
    if (lambda == 0.0) continue;
    line.points.push_back({lambda, scaled_motion(lambda, 0.0).cycle->sticking_degree});
    table.add({0.0, lambda, line.points.back().y, scaled_paper_cycle(lambda, 0.0).value().sticking_degree});
  }
  return line;
}

/// The curves of one damping ratio, with its limits as markers, into both panels' content.
void add_damped_curves(const PrintedLimit& printed, Colour colour, Table& table, Table& limits, chart::Panel& panel) {
  const double zeta = printed.damping_ratio;
  const double critical = critical_lambda(zeta);
  const double first = first_solvable_lambda(zeta);
  const double jump = sticking_degree_at_limit(zeta);
  chart::Line exact{fmt::format("ζ = {}, exact", zeta), colour, Stroke::Solid, {{critical, jump}}};
  chart::Line paper{"", colour, Stroke::Dashed, {}};
  for (const double lambda : lambdas_from(first, critical)) {
    const Motion motion = scaled_motion(lambda, zeta);
    const Result<PaperCycle> approximation = scaled_paper_cycle(lambda, zeta);
    const double exact_degree = motion.cycle ? motion.cycle->sticking_degree : kNone;
    const double paper_degree = approximation ? approximation.value().sticking_degree : kNone;
    table.add({zeta, lambda, exact_degree, paper_degree});
    if (lambda > critical) exact.points.push_back({lambda, exact_degree});
    paper.points.push_back({lambda, paper_degree});
  }
  limits.add({zeta, critical, jump, printed.lambda, first, critical / printed.lambda});
  panel.lines.push_back({"", colour, Stroke::Dotted, {{critical, jump}, {critical, 0.0}}});
  panel.markers.push_back({"", colour, Shape::Dot, {{critical, jump}}});
  panel.markers.push_back({"", colour, Shape::Ring, {{first, paper.points.front().y}}});
  panel.markers.push_back({"", colour, Shape::Triangle, {{printed.lambda, 0.0}}});
  panel.lines.push_back(paper);
  panel.lines.push_back(exact);
}

/// Entries of the legend that apply to every colour.
void add_keys(chart::Panel& panel) {
  panel.lines.push_back({"paper's approximation, eq. (38)", Colour::Grey, Stroke::Dashed, {}});
  panel.markers.push_back({"exact limit, where it jumps to 0", Colour::Grey, Shape::Dot, {}});
  panel.markers.push_back({"first λ with a root of eq. (36)", Colour::Grey, Shape::Ring, {}});
  panel.markers.push_back({"limit printed in the paper: 0.2, 0.5, 0.9", Colour::Grey, Shape::Triangle, {}});
}

chart::Chart chart_of(chart::Panel whole) {
  whole.height_px = 300.0;
  whole.x = {"stick-slip parameter λ  [-]", 0.0, kLargestDampedLambda};
  whole.y = {"sticking degree  [-]", 0.0, 0.8};
  chart::Panel close = whole;  // the same close to the limits, without the legend
  for (chart::Line& line : close.lines) line.name.clear();
  for (chart::Markers& markers : close.markers) markers.name.clear();
  close.x.high = 1.8;
  close.y.high = 0.35;
  add_keys(whole);
  for (const PrintedLimit& printed : kPrintedLimits) {
    const double critical = critical_lambda(printed.damping_ratio);
    close.notes.push_back({{critical, sticking_degree_at_limit(printed.damping_ratio)},
                           fmt::format("λ = {:.4f}", critical),
                           Colour::Black,
                           20.0,
                           14.0});
  }
  return {"Figure 7: sticking degree with damping",
          {"Solid: exact. Dashed: the paper's approximation, which ends where its eq. (36) has no root.",
           "The printed limits lie where neither has a stick-slip motion. Below: close to the limits."},
          {whole, close}};
}

}  // namespace

std::vector<FigureFile> damped_sticking_degree() {
  Table table({"figure 7 of the paper: sticking degree with damping, exact and as the paper's eq. (38)",
               "empty: no stick-slip (exact), or no root of eq. (36) (paper)"},
              {"damping_ratio", "lambda", "sticking_degree_exact", "sticking_degree_paper"});
  Table limits({"figure 7 of the paper: the limits of stick-slip, exact, as printed, and the first lambda at which "
                "the paper's eq. (36) has a root"},
               {"damping_ratio", "lambda_limit_exact", "sticking_degree_at_exact_limit", "lambda_limit_printed",
                "lambda_first_root_of_eq_36", "critical_speed_printed_over_exact"});
  chart::Panel panel;
  panel.lines.push_back(undamped_curve(table));
  for (std::size_t i = 0; i < kPrintedLimits.size(); ++i) {
    add_damped_curves(kPrintedLimits.at(i), kDampedColours.at(i), table, limits, panel);
  }
  return {
      {"figure_7.csv", table.csv()}, {"figure_7_limits.csv", limits.csv()}, {"figure_7.svg", to_svg(chart_of(panel))}};
}

}  // namespace slipfit::figures
