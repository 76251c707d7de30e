// Figures 4 and 8: the stick-slip amplitude (periodic displacement) against the driving speed.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "chart/chart.hpp"
#include "figures/parts.hpp"

namespace slipfit::figures {
namespace {

using chart::Colour, chart::Shape, chart::Stroke;

constexpr double kMass_kg = 0.5e-3;                                        // captions of figures 4 and 8
constexpr double kForceDifference_N = 5.0;                                 // caption of figure 4; assumed for figure 8
constexpr double kSpringDrop_m = 1e-3;                                     // X_s in the caption of figure 8
constexpr double kFastest_m_per_s = 10.0;                                  // assumed
constexpr double kSlowest_m_per_s = 0.01;                                  // not 0: lambda has no limit there
constexpr std::array<double, 4> kSpringDrops_m{0.5e-3, 1e-3, 2e-3, 4e-3};  // assumed
constexpr std::array<double, 4> kDampingRatios{0.0, 0.015, 0.05, 0.1};     // assumed: those of figure 7
constexpr std::array<Colour, 4> kColours{Colour::Black, Colour::Blue, Colour::Vermillion, Colour::Green};
const std::string kSpeedLabel = "driving speed V  [m/s]";

/// X_s = (F_s - F_k) / k gives the stiffness; only the difference of the forces counts.
Slider slider_with(double spring_drop_m, double damping_ratio) {
  const double stiffness_N_per_m = kForceDifference_N / spring_drop_m;
  return Slider::create(stiffness_N_per_m, std::sqrt(stiffness_N_per_m / kMass_kg), damping_ratio).value();
}

Friction friction() {
  return Friction::create(kForceDifference_N, 0.0).value();
}

/// V at a lambda, [Paper] eq. (9); slightly less: rounding must not put it beyond a limit of stick-slip.
double speed_at(double lambda, const Slider& slider) {
  constexpr double kInside = 1.0 - 1e-14;
  return kInside * slider.natural_frequency_rad_per_s() * kForceDifference_N / (slider.stiffness_N_per_m() * lambda);
}

std::vector<double> speeds_with(const std::vector<double>& more) {
  std::vector<double> speeds = evenly_spaced(kSlowest_m_per_s, kFastest_m_per_s, 200);
  for (const double speed : more) {
    if (speed < kFastest_m_per_s) speeds.push_back(speed);
  }
  std::ranges::sort(speeds);
  return speeds;
}

double displacement_m(const Motion& motion) {
  return motion.cycle ? motion.cycle->periodic_displacement_m : kNone;
}

/// The curves of figure 8 for one damping ratio.
struct DampedCurves {
  chart::Line exact, paper, exact_ratio, paper_ratio, corrected_ratio;
};

DampedCurves damped_curves(double zeta, Colour colour, Table& table) {
  const Slider slider = slider_with(kSpringDrop_m, zeta);
  DampedCurves curves{{fmt::format("ζ = {}, exact", zeta), colour, Stroke::Solid, {}},
                      {"", colour, Stroke::Dashed, {}},
                      {"", colour, Stroke::Solid, {}},
                      {"", colour, Stroke::Dashed, {}},
                      {"", colour, Stroke::Dotted, {}}};
  std::vector<double> ends;
  if (zeta > 0.0) ends = {speed_at(critical_lambda(zeta), slider), speed_at(first_solvable_lambda(zeta), slider)};
  for (const double speed : speeds_with(ends)) {
    const Motion motion = damped_motion(slider, friction(), speed);
    const Result<PaperCycle> paper = paper_cycle(slider, friction(), speed);
    const double undamped_m = displacement_m(damped_motion(slider_with(kSpringDrop_m, 0.0), friction(), speed));
    const double exact_m = displacement_m(motion);
    const double printed_m = paper ? paper.value().displacement_printed_m : kNone;
    const double corrected_m = paper ? paper.value().displacement_corrected_m : kNone;
    table.add({zeta, speed, motion.lambda, exact_m, printed_m, corrected_m});
    curves.exact.points.push_back({speed, 1e3 * exact_m});
    curves.paper.points.push_back({speed, 1e3 * printed_m});
    curves.exact_ratio.points.push_back({speed, exact_m / undamped_m});
    curves.paper_ratio.points.push_back({speed, printed_m / undamped_m});
    curves.corrected_ratio.points.push_back({speed, corrected_m / undamped_m});
  }
  return curves;
}

/// The last exact point of a curve, and its speed as a dotted line down to the axis.
void mark_critical_speed(const chart::Line& curve, bool with_text, chart::Panel& panel) {
  const auto is_number = [](const chart::Point& point) { return std::isfinite(point.y); };
  const auto last = std::find_if(curve.points.rbegin(), curve.points.rend(), is_number);
  panel.lines.push_back({"", curve.colour, Stroke::Dotted, {*last, {last->x, panel.y.low}}});
  panel.markers.push_back({"", curve.colour, Shape::Dot, {*last}});
  if (!with_text) return;
  panel.notes.push_back({*last, fmt::format("{:.2f} m/s", last->x), Colour::Black, 35.0, 14.0});
}

chart::Chart damped_chart(chart::Panel upper, chart::Panel lower) {
  upper.height_px = 300.0;
  upper.lines.push_back({"paper's approximation, eq. (40)", Colour::Grey, Stroke::Dashed, {}});
  upper.lines.push_back({"the same, corrected (below)", Colour::Grey, Stroke::Dotted, {}});
  upper.markers.push_back({"exact critical speed", Colour::Grey, Shape::Dot, {}});
  lower.height_px = 200.0;
  return {"Figure 8: stick-slip amplitude with damping",
          {"m = 0.5 g and Xₛ = 1 mm as in the paper. Below: relative to the undamped amplitude.",
           "Assumed: k = 5 kN/m (Fₛ − Fₖ = 5 N as in figure 4), ζ, the range of V."},
          {upper, lower}};
}

}  // namespace

std::vector<FigureFile> amplitude_against_speed() {
  Table table(
      {"figure 4 of the paper: undamped, eq. (23); mass 0.5 gram, F_s - F_k = 5 N",
       "assumed: the values of X_s = (F_s - F_k)/k and the range of speed, which the paper's text does not give"},
      {"assumed_X_s_m", "stiffness_N_per_m", "speed_m_per_s", "lambda", "displacement_m"});
  chart::Panel panel;
  for (std::size_t i = kSpringDrops_m.size(); i-- > 0;) {  // the uppermost curve first in the legend
    const Slider slider = slider_with(kSpringDrops_m.at(i), 0.0);
    chart::Line line{
        fmt::format("Xₛ = {} mm, k = {} kN/m", 1e3 * kSpringDrops_m.at(i), 1e-3 * slider.stiffness_N_per_m()),
        kColours.at(i),
        Stroke::Solid,
        {}};
    for (const double speed : speeds_with({})) {
      const Motion motion = damped_motion(slider, friction(), speed);
      table.add({kSpringDrops_m.at(i), slider.stiffness_N_per_m(), speed, motion.lambda, displacement_m(motion)});
      line.points.push_back({speed, 1e3 * displacement_m(motion)});
    }
    panel.lines.push_back(line);
  }
  panel.x = {kSpeedLabel, 0.0, kFastest_m_per_s};
  panel.y = {"stick-slip amplitude Δx  [mm]", 0.0, 45.0};
  const chart::Chart chart{"Figure 4: stick-slip amplitude against speed, undamped",
                           {"Exact; so is the paper's eq. (23). m = 0.5 g and Fₛ − Fₖ = 5 N as in the paper.",
                            "Assumed: the values of Xₛ = (Fₛ − Fₖ)/k and the range of V."},
                           {panel}};
  return {{"figure_4.csv", table.csv()}, {"figure_4.svg", to_svg(chart)}};
}

std::vector<FigureFile> damped_amplitude_against_speed() {
  const std::string assumed = "assumed: stiffness 5 kN/m (F_s - F_k = 5 N of figure 4), damping ratios, range of speed";
  Table table(
      {"figure 8 of the paper: displacement of a cycle with damping; mass 0.5 gram, X_s = 1 mm", assumed,
       "exact; the paper's eq. (40) as printed; the same corrected. Empty: no stick-slip, or no root of eq. (36)"},
      {"assumed_damping_ratio", "speed_m_per_s", "lambda", "displacement_exact_m", "displacement_paper_m",
       "displacement_paper_corrected_m"});
  Table limits(
      {"figure 8 of the paper: the speeds above which there is no stick-slip (exact) and no root of eq. (36)", assumed},
      {"assumed_damping_ratio", "critical_speed_m_per_s", "largest_speed_of_eq_36_m_per_s"});
  chart::Panel upper, lower;
  upper.x = {"", 0.0, kFastest_m_per_s};
  upper.y = {"amplitude Δx  [mm]", 0.0, 20.0};
  lower.x = {kSpeedLabel, 0.0, kFastest_m_per_s};
  lower.y = {"Δx / Δx(ζ = 0)  [-]", 0.8, 1.1};
  for (std::size_t i = 0; i < kDampingRatios.size(); ++i) {
    const double zeta = kDampingRatios.at(i);
    const DampedCurves curves = damped_curves(zeta, kColours.at(i), table);
    if (zeta > 0.0) {
      const Slider slider = slider_with(kSpringDrop_m, zeta);
      limits.add({zeta, speed_at(critical_lambda(zeta), slider), speed_at(first_solvable_lambda(zeta), slider)});
      mark_critical_speed(curves.exact, true, upper);
      mark_critical_speed(curves.exact_ratio, false, lower);
    }
    upper.lines.insert(upper.lines.end(), {curves.paper, curves.exact});
    lower.lines.insert(lower.lines.end(), {curves.paper_ratio, curves.corrected_ratio, curves.exact_ratio});
  }
  return {{"figure_8.csv", table.csv()},
          {"figure_8_critical_speeds.csv", limits.csv()},
          {"figure_8.svg", to_svg(damped_chart(upper, lower))}};
}

}  // namespace slipfit::figures
