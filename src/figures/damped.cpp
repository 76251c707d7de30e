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

/// The curves of one damping ratio, with its limits as markers.
void add_damped_curves(const PrintedLimit& printed, Colour colour, Table& table, Table& limits, chart::Panel& panel) {
  const double zeta = printed.damping_ratio;
  const double critical = critical_lambda(zeta);
  const double first = first_solvable_lambda(zeta);
  const double jump = sticking_degree_at_limit(zeta);
  for (const double lambda : lambdas_from(first, critical)) {
    const Motion motion = scaled_motion(lambda, zeta);
    const Result<PaperCycle> paper = scaled_paper_cycle(lambda, zeta);
    table.add({zeta, lambda, motion.cycle ? motion.cycle->sticking_degree : kNone,
               paper ? paper.value().sticking_degree : kNone});
  }
  chart::Line exact = table.line({fmt::format("ζ = {}, exact", zeta), colour, Stroke::Solid, {}}, 1, 2, zeta);
  std::erase_if(exact.points, [critical](const chart::Point& point) { return !(point.x > critical); });
  exact.points.insert(exact.points.begin(), {critical, jump});
  const chart::Line paper = table.line({"", colour, Stroke::Dashed, {}}, 1, 3, zeta);
  limits.add({zeta, critical, jump, printed.lambda, first, critical / printed.lambda});
  panel.lines.push_back({"", colour, Stroke::Dotted, {{critical, jump}, {critical, 0.0}}});
  panel.markers.push_back({"", colour, Shape::Dot, {{critical, jump}}});
  panel.markers.push_back({"", colour, Shape::Ring, {{first, paper.points.front().y}}});
  panel.markers.push_back({"", colour, Shape::Triangle, {{printed.lambda, 0.0}}});
  panel.lines.push_back(paper);
  panel.lines.push_back(exact);
}

chart::Chart chart_of(chart::Panel whole) {
  chart::Panel close = whole;  // the same close to the limits, without the legend
  for (chart::Line& line : close.lines) line.name.clear();
  for (chart::Markers& markers : close.markers) markers.name.clear();
  close.x.high = 1.8;
  close.y.high = 0.35;
  // Entries of the legend that apply to every colour.
  whole.lines.push_back({"paper's approximation, eq. (38)", Colour::Grey, Stroke::Dashed, {}});
  whole.markers.push_back({"exact limit, where it jumps to 0", Colour::Grey, Shape::Dot, {}});
  whole.markers.push_back({"first λ with a root of eq. (36)", Colour::Grey, Shape::Ring, {}});
  whole.markers.push_back({"limit printed in the paper: 0.2, 0.5, 0.9", Colour::Grey, Shape::Triangle, {}});
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
  for (const double lambda : evenly_spaced(0.0, kLargestDampedLambda, 200)) {
    if (lambda == 0.0) continue;
    table.add({0.0, lambda, scaled_motion(lambda, 0.0).cycle->sticking_degree,
               scaled_paper_cycle(lambda, 0.0).value().sticking_degree});
  }
  chart::Panel panel{.x = {"stick-slip parameter λ  [-]", 0.0, kLargestDampedLambda},
                     .y = {"sticking degree  [-]", 0.0, 0.8},
                     .height_px = 300.0,
                     .lines = {table.line({"ζ = 0, eq. (22)", Colour::Black, Stroke::Solid, {{0.0, 0.0}}}, 1, 2)}};
  for (std::size_t i = 0; i < kPrintedLimits.size(); ++i) {
    add_damped_curves(kPrintedLimits.at(i), kDampedColours.at(i), table, limits, panel);
  }
  std::vector<FigureFile> files = files_of("figure_7", table, chart_of(panel));
  files.insert(files.begin() + 1, {"figure_7_limits.csv", limits.csv()});
  return files;
}

}  // namespace slipfit::figures
