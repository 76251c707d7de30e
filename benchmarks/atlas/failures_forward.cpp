#include <cmath>
#include <map>

#include "failure_plane.hpp"
#include "forward_methods.hpp"
#include "slipfit/model/motion.hpp"

namespace atlas {
namespace {

using chart::Line, chart::Panel;

constexpr double kGross = 0.01;  // relative error of the period that counts as wrong
constexpr WaveTimes kAnyTimes{0.1, 1};

Mark compare(const Answer& answer, const Answer& truth) {
  if (answer.outcome == Outcome::GaveUp) return Mark::Silent;
  if (answer.outcome != truth.outcome) return truth.outcome == Outcome::Cycle ? Mark::Missed : Mark::Invented;
  if (truth.outcome == Outcome::NoCycle) return Mark::Fine;
  return std::abs(answer.period / truth.period - 1.0) > kGross ? Mark::Wrong : Mark::Fine;
}

std::vector<ForwardMethod> chosen(const std::map<std::string, std::vector<std::string>>& settings) {
  std::vector<ForwardMethod> methods;
  for (ForwardMethod& method : forward_methods()) {
    const auto family = settings.find(method.family);
    if (family == settings.end()) continue;
    for (const std::string& setting : family->second) {
      if (setting == method.setting) methods.push_back(method);
    }
  }
  return methods;
}

std::string title_of(const ForwardMethod& method) {
  return method.setting.empty() ? method.family : method.family + ", " + method.setting;
}

Line limit_line(const std::vector<double>& zetas) {
  Line line{"", chart::Colour::Black, chart::Stroke::Solid, {}};
  for (const double zeta : zetas) line.points.push_back({slipfit::critical_lambda(zeta), zeta});
  return line;
}

chart::Chart lambda_zeta(Effort effort) {
  const std::size_t fineness = effort == Effort::Full ? 2 : 1;
  const Plane plane{{"stick-slip parameter λ  [-]", log_spaced(0.03, 300.0, 12 * fineness + 1)},
                    {"damping ratio ζ  [-]", log_spaced(0.002, 0.8, 6 * fineness + 1)},
                    210.0,
                    {limit_line(log_spaced(0.002, 0.8, 60))}};
  chart::Chart chart{"Where forward methods fail, constant friction",
                     explain_marks({Mark::Silent, Mark::Wrong, Mark::Missed, Mark::Invented}),
                     {}};
  chart.remarks.emplace_back("wrong: the period is off by more than 1 %; the line is the exact limit of stick-slip");
  for (const ForwardMethod& method : chosen({{"undamped closed form", {""}},
                                             {"paper's approximation", {""}},
                                             {"RK4, sign switching", {"0.1", "0.01"}},
                                             {"time stepping (Moreau)", {"0.01"}},
                                             {"ODE 5(4), event location", {"0.001", "1e-05"}},
                                             {"switch model (Leine)", {"0.0001"}},
                                             {"tanh-smoothed", {"0.001"}},
                                             {"velocity tier", {""}},
                                             {"exact damped", {""}}})) {
    chart.panels.push_back(draw_plane(plane, title_of(method), [&](double lambda, double zeta) {
      const ForwardScene scene{lambda, zeta, 0.0, 0.0};
      return compare(method.run(scene, kAnyTimes), solve_reference(scene, 1).answer);
    }));
  }
  return chart;
}

/// Just above and just below the limit, where the body all but comes to rest in passing.
chart::Chart grazing(Effort effort) {
  const std::size_t fineness = effort == Effort::Full ? 2 : 1;
  const Plane plane{{"distance from the limit, |λ / λ_c − 1|  [-]", log_spaced(1e-11, 0.1, 10 * fineness + 1)},
                    {"damping ratio ζ  [-]", log_spaced(0.005, 0.8, 5 * fineness + 1)},
                    190.0,
                    {}};
  chart::Chart chart{
      "Grazing: does the slip come to rest?", explain_marks({Mark::Silent, Mark::Missed, Mark::Invented}), {}};
  chart.remarks.emplace_back("both sides of the limit are asked; the mark is that of the side that goes wrong");
  for (const ForwardMethod& method : chosen({{"RK4, sign switching", {"0.01", "0.001"}},
                                             {"time stepping (Moreau)", {"0.001"}},
                                             {"ODE 5(4), event location", {"1e-05", "1e-09", "1e-11"}},
                                             {"switch model (Leine)", {"1e-06"}},
                                             {"velocity tier", {""}},
                                             {"exact damped", {""}}})) {
    chart.panels.push_back(draw_plane(plane, title_of(method), [&](double distance, double zeta) {
      const double limit = slipfit::critical_lambda(zeta);
      const auto outcome = [&](double lambda) { return method.run({lambda, zeta, 0.0, 0.0}, kAnyTimes).outcome; };
      const Outcome above = outcome(limit * (1.0 + distance));
      const Outcome below = outcome(limit * (1.0 - distance));
      if (above == Outcome::NoCycle) return Mark::Missed;
      if (below == Outcome::Cycle) return Mark::Invented;
      return above == Outcome::GaveUp || below == Outcome::GaveUp ? Mark::Silent : Mark::Fine;
    }));
  }
  return chart;
}

/// Friction that bends within the speeds of a slip: what tier is needed.
chart::Chart friction_of_speed(Effort effort) {
  const std::size_t fineness = effort == Effort::Full ? 2 : 1;
  const Plane plane{{"|α| × largest sliding speed, |α| V λ  [-]", log_spaced(1e-3, 30.0, 8 * fineness + 1)},
                    {"|f₁| / (Fₛ − Fₖ)  [-]", log_spaced(0.003, 3.0, 5 * fineness + 1)},
                    210.0,
                    {}};
  chart::Chart chart{"Friction that depends on the speed, λ = 20, ζ = 0.05",
                     explain_marks({Mark::Silent, Mark::Wrong, Mark::Missed, Mark::Invented}),
                     {}};
  chart.remarks.emplace_back("wrong: the period is off by more than 1 %");
  for (const double sign : {-1.0, 1.0}) {
    for (const ForwardMethod& method :
         chosen({{"exact damped", {""}}, {"ODE 5(4), event location", {"1e-05"}}, {"velocity tier", {""}}})) {
      const std::string title = title_of(method) + (sign < 0.0 ? ", weakening (α < 0)" : ", strengthening (α > 0)");
      chart.panels.push_back(draw_plane(plane, title, [&](double bend, double strength) {
        constexpr double kLambda = 20.0;
        const double rate = sign * bend / kLambda;
        const ForwardScene scene{kLambda, 0.05, strength * kLambda * rate, rate};
        return compare(method.run(scene, kAnyTimes), solve_reference(scene, 1).answer);
      }));
    }
  }
  return chart;
}

}  // namespace

std::vector<File> map_forward_failures(Effort effort) {
  return {{"failures_forward.svg", to_svg(lambda_zeta(effort))},
          {"failures_grazing.svg", to_svg(grazing(effort))},
          {"failures_speed.svg", to_svg(friction_of_speed(effort))}};
}

}  // namespace atlas
