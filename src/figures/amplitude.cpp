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

/// Adds the rows of figure 8 for one damping ratio, and to `ratios` the displacements over the undamped one.
void add_damped(double zeta, Table& table, Table& ratios) {
  const Slider slider = slider_with(kSpringDrop_m, zeta);
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
    ratios.add({zeta, speed, exact_m / undamped_m, printed_m / undamped_m, corrected_m / undamped_m});
  }
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

}  // namespace

std::vector<FigureFile> amplitude_against_speed() {
  Table table(
      {"figure 4 of the paper: undamped, eq. (23); mass 0.5 gram, F_s - F_k = 5 N",
       "assumed: the values of X_s = (F_s - F_k)/k and the range of speed, which the paper's text does not give"},
      {"assumed_X_s_m", "stiffness_N_per_m", "speed_m_per_s", "lambda", "displacement_m"});
  chart::Panel panel{.x = {kSpeedLabel, 0.0, kFastest_m_per_s}, .y = {"stick-slip amplitude Δx  [mm]", 0.0, 45.0}};
  for (std::size_t i = kSpringDrops_m.size(); i-- > 0;) {  // the uppermost curve first in the legend
    const double drop_m = kSpringDrops_m.at(i);
    const Slider slider = slider_with(drop_m, 0.0);
    const double stiffness_N_per_m = slider.stiffness_N_per_m();
    for (const double speed : speeds_with({})) {
      const Motion motion = damped_motion(slider, friction(), speed);
      table.add({drop_m, stiffness_N_per_m, speed, motion.lambda, displacement_m(motion)});
    }
    const std::string name = fmt::format("Xₛ = {} mm, k = {} kN/m", 1e3 * drop_m, 1e-3 * stiffness_N_per_m);
    panel.lines.push_back(table.line({name, kColours.at(i), Stroke::Solid, {}}, 2, 4, drop_m, 1e3));
  }
  return files_of("figure_4", table,
                  {"Figure 4: stick-slip amplitude against speed, undamped",
                   {"Exact; so is the paper's eq. (23). m = 0.5 g and Fₛ − Fₖ = 5 N as in the paper.",
                    "Assumed: the values of Xₛ = (Fₛ − Fₖ)/k and the range of V."},
                   {panel}});
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
  Table ratios({}, {"damping_ratio", "speed_m_per_s", "exact", "paper", "corrected"});
  chart::Panel upper{.x = {"", 0.0, kFastest_m_per_s}, .y = {"amplitude Δx  [mm]", 0.0, 20.0}, .height_px = 300.0};
  chart::Panel lower{
      .x = {kSpeedLabel, 0.0, kFastest_m_per_s}, .y = {"Δx / Δx(ζ = 0)  [-]", 0.8, 1.1}, .height_px = 200.0};
  for (std::size_t i = 0; i < kDampingRatios.size(); ++i) {
    const double zeta = kDampingRatios.at(i);
    const Colour colour = kColours.at(i);
    add_damped(zeta, table, ratios);
    const chart::Line exact =
        table.line({fmt::format("ζ = {}, exact", zeta), colour, Stroke::Solid, {}}, 1, 3, zeta, 1e3);
    const chart::Line exact_ratio = ratios.line({"", colour, Stroke::Solid, {}}, 1, 2, zeta);
    if (zeta > 0.0) {
      const Slider slider = slider_with(kSpringDrop_m, zeta);
      limits.add({zeta, speed_at(critical_lambda(zeta), slider), speed_at(first_solvable_lambda(zeta), slider)});
      mark_critical_speed(exact, true, upper);
      mark_critical_speed(exact_ratio, false, lower);
    }
    upper.lines.insert(upper.lines.end(), {table.line({"", colour, Stroke::Dashed, {}}, 1, 4, zeta, 1e3), exact});
    lower.lines.insert(lower.lines.end(), {ratios.line({"", colour, Stroke::Dashed, {}}, 1, 3, zeta),
                                           ratios.line({"", colour, Stroke::Dotted, {}}, 1, 4, zeta), exact_ratio});
  }
  upper.lines.push_back({"paper's approximation, eq. (40)", Colour::Grey, Stroke::Dashed, {}});
  upper.lines.push_back({"the same, corrected (below)", Colour::Grey, Stroke::Dotted, {}});
  upper.markers.push_back({"exact critical speed", Colour::Grey, Shape::Dot, {}});
  std::vector<FigureFile> files =
      files_of("figure_8", table,
               {"Figure 8: stick-slip amplitude with damping",
                {"m = 0.5 g and Xₛ = 1 mm as in the paper. Below: relative to the undamped amplitude.",
                 "Assumed: k = 5 kN/m (Fₛ − Fₖ = 5 N as in figure 4), ζ, the range of V."},
                {upper, lower}});
  files.insert(files.begin() + 1, {"figure_8_critical_speeds.csv", limits.csv()});
  return files;
}

}  // namespace slipfit::figures
