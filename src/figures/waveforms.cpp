// Figures 5 and 6: one undamped cycle in time, from the beginning of the slip.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "chart/chart.hpp"
#include "figures/parts.hpp"
#include "model/slip.hpp"

namespace slipfit::figures {
namespace {

using chart::Colour, chart::Stroke;

constexpr std::array<Colour, 4> kWaveColours{Colour::Blue, Colour::Vermillion, Colour::Green, Colour::Purple};
constexpr std::array<double, 4> kLambdas{0.5, 1.0, 2.0, 5.0};          // assumed
constexpr std::array<double, 4> kFrictionRatios{1.25, 1.5, 2.0, 2.5};  // assumed but for 2.5
constexpr double kForceLambda = 2.0;                                   // figure 6
const std::string kTimeLabel = "time since the slip began, τ = ωₙ t  [rad]";

/// Spring force above F_k in k V / w_n, and the sliding speed in V.
struct State {
  double z = 0.0;
  double speed_ratio = 0.0;
};

/// The undamped cycle repeats after slip and stick; [Paper] eqs (25)-(27).
State state_at(const model::Slip& slip, double tau) {
  const double stick = slip.z0 - slip.end.z;
  const double phase = std::fmod(tau, slip.tau_end + stick);
  if (phase >= slip.tau_end) return {slip.end.z + phase - slip.tau_end, 0.0};
  const model::SlipPoint<double> point = model::slip_point(slip.z0, 0.0, phase);
  return {point.z, std::max(0.0, 1.0 - point.dz)};  // round-off at the very start of slip
}

/// Even steps, with the ends of slip and of stick among them.
std::vector<double> times_of(const model::Slip& slip, int cycles) {
  const double period = slip.tau_end + slip.z0 - slip.end.z;
  std::vector<double> times = evenly_spaced(0.0, cycles * period, 200 * cycles);
  for (int cycle = 0; cycle < cycles; ++cycle) times.push_back(cycle * period + slip.tau_end);
  std::ranges::sort(times);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

}  // namespace

std::vector<FigureFile> velocity_ratio() {
  Table table({"figure 5 of the paper: undamped, eq. (25) with the phase atan(lambda) - pi; one period from slip onset",
               "assumed: the values of lambda, which the paper's text does not give"},
              {"assumed_lambda", "tau_rad", "velocity_ratio"});
  chart::Panel panel{.x = {kTimeLabel, 0.0, 14.0}, .y = {"velocity ratio v* = (sliding speed) / V  [-]", 0.0, 6.5}};
  for (std::size_t i = 0; i < kLambdas.size(); ++i) {
    const double lambda = kLambdas.at(i);
    const Colour colour = kWaveColours.at(i);
    const model::Slip slip = model::solve_slip(lambda, 0.0);
    for (const double tau : times_of(slip, 1)) table.add({lambda, tau, state_at(slip, tau).speed_ratio});
    panel.lines.push_back(table.line({fmt::format("λ = {}", lambda), colour, Stroke::Solid, {}}, 1, 2, lambda));
    const double end = panel.lines.back().points.back().x;
    panel.markers.push_back({"", colour, chart::Shape::Ring, {{slip.tau_end, 0.0}}});
    panel.markers.push_back({"", colour, chart::Shape::Cross, {{end, 0.0}}});
  }
  panel.markers.push_back({"end of slip", Colour::Grey, chart::Shape::Ring, {}});
  panel.markers.push_back({"end of stick", Colour::Grey, chart::Shape::Cross, {}});
  return files_of("figure_5", table,
                  {"Figure 5: velocity ratio in one period, undamped",
                   {"Exact: the paper's eq. (25) with the phase of eq. (14) corrected to atan λ − π.",
                    "Assumed: the values of λ, which the text of the paper does not give."},
                   {panel}});
}

std::vector<FigureFile> spring_force() {
  Table table({"figure 6 of the paper: undamped, eqs (26) and (27), lambda = 2; two periods from slip onset",
               "assumed: friction_ratio 1.25, 1.5 and 2; the paper's text gives 2.5 only"},
              {"assumed_friction_ratio", "tau_rad", "normalized_spring_force"});
  const model::Slip slip = model::solve_slip(kForceLambda, 0.0);
  chart::Panel panel{.x = {kTimeLabel, 0.0, 17.0}, .y = {"spring force Fₑ* = Fₑ / (Fₛ − Fₖ)  [-]", -1.0, 8.0}};
  for (std::size_t i = 0; i < kFrictionRatios.size(); ++i) {
    const double ratio = kFrictionRatios.at(i);
    for (const double tau : times_of(slip, 2)) {
      table.add({ratio, tau, 1.0 / (ratio - 1.0) + state_at(slip, tau).z / kForceLambda});  // [Paper] eqs (26), (27)
    }
    const std::string name = fmt::format("γ = {}{}", ratio, ratio == 2.5 ? "" : " (assumed)");
    panel.lines.push_back(table.line({name, kWaveColours.at(i), Stroke::Solid, {}}, 1, 2, ratio));
  }
  panel.areas = {{"spring in compression", Colour::Grey, chart::Fill::Plain, {{0, -1}, {0, 0}, {17, 0}, {17, -1}}}};
  return files_of("figure_6", table,
                  {"Figure 6: spring force in two periods at λ = 2, undamped",
                   {"Exact; so are the paper's eqs (26) and (27). γ = Fₛ/Fₖ.",
                    "Assumed: the values of γ but for 2.5, which the text of the paper gives."},
                   {panel}});
}

}  // namespace slipfit::figures
