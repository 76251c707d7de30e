// Figures 2 and 3: an undamped cycle against lambda.

#include <numbers>
#include <string>

#include "chart/chart.hpp"
#include "figures/parts.hpp"

namespace slipfit::figures {
namespace {

using chart::Colour, chart::Stroke;

constexpr double kLargestLambda = 10.0;
const std::string kRemark = "Exact; so are the paper's equations, by number. Assumed: the range of λ.";
const std::string kLambdaLabel = "stick-slip parameter λ  [-]";

/// lambda = 0 is the limit: a slip of a full turn and no stick.
LimitCycle cycle_at(double lambda) {
  const Motion motion = scaled_motion(lambda, 0.0);
  if (motion.cycle) return *motion.cycle;
  LimitCycle turn;
  turn.slip_s = turn.period_s = turn.periodic_displacement_m = 2.0 * std::numbers::pi;
  return turn;
}

}  // namespace

std::vector<FigureFile> slip_and_stick_times() {
  Table table({"figure 2 of the paper: undamped times, eqs (20) and (21); range of lambda assumed"},
              {"lambda", "slip_time_times_natural_frequency_rad", "stick_time_times_natural_frequency_rad",
               "period_times_natural_frequency_rad"});
  for (const double lambda : evenly_spaced(0.0, kLargestLambda, 200)) {
    const LimitCycle cycle = cycle_at(lambda);
    table.add({lambda, cycle.slip_s, cycle.stick_s, cycle.period_s});
  }
  const chart::Panel panel{
      .x = {kLambdaLabel, 0.0, kLargestLambda},
      .y = {"time × natural frequency  [rad]", 0.0, 25.0},
      .lines = {table.line({"period, slip + stick", Colour::Black, Stroke::DashDotted, {}}, 0, 3),
                table.line({"stick, 2λ, eq. (21)", Colour::Vermillion, Stroke::Solid, {}}, 0, 2),
                table.line({"slip, 2(π − atan λ), eq. (20)", Colour::Blue, Stroke::Solid, {}}, 0, 1)}};
  return files_of("figure_2", table, {"Figure 2: slip time, stick time and period, undamped", {kRemark}, {panel}});
}

std::vector<FigureFile> sticking_degree_and_amplitude() {
  Table table({"figure 3 of the paper: undamped cycle, eqs (22) and (24); range of lambda assumed"},
              {"lambda", "sticking_degree", "normalized_displacement"});
  for (const double lambda : evenly_spaced(0.0, kLargestLambda, 200)) {
    const LimitCycle cycle = cycle_at(lambda);
    table.add({lambda, cycle.sticking_degree, cycle.periodic_displacement_m});
  }
  const chart::Panel upper{.x = {"", 0.0, kLargestLambda},
                           .y = {"sticking degree  [-]", 0.0, 1.0},
                           .height_px = 210.0,
                           .lines = {table.line({"sticking degree, eq. (22)", Colour::Blue, Stroke::Solid, {}}, 0, 1)}};
  const chart::Panel lower{
      .x = {kLambdaLabel, 0.0, kLargestLambda},
      .y = {"ξ = Δx ωₙ / V  [-]", 0.0, 25.0},
      .height_px = 210.0,
      .lines = {table.line({"displacement ξ, eq. (24)", Colour::Vermillion, Stroke::Solid, {}}, 0, 2)}};
  return files_of("figure_3", table,
                  {"Figure 3: sticking degree and normalized displacement, undamped", {kRemark}, {upper, lower}});
}

}  // namespace slipfit::figures
