#include <algorithm>
#include <cmath>

#include "failure_plane.hpp"
#include "fit_methods.hpp"

namespace atlas {
namespace {

constexpr double kTolerated = 0.11;  // share of wrong trials below which a cell is called right

/// Claims to know it, and is more than 4 standard errors and 2 % off.
bool confidently_wrong(const FitAnswer& answer, std::size_t parameter, double truth) {
  const slipfit::Estimate& estimate = answer.estimates[parameter];
  if (!answer.sure[parameter] || !estimate.value) return false;
  const double allowed = std::max(0.02 * truth, 4.0 * estimate.standard_error.value_or(0.0));
  return !(std::abs(*estimate.value - truth) <= allowed);
}

Mark judge(const FitMethod& method, const Factors& factors, std::size_t trials) {
  std::size_t none = 0, unsure = 0, wrong = 0;
  for (std::size_t i = 0; i < trials; ++i) {
    const FitAnswer answer = method.run(factors, 7000 + i).answer;
    const auto truth = truth_of(make_scene(factors, 7000 + i));
    bool any_wrong = false;
    for (std::size_t p = 0; p < kFitParameters; ++p) any_wrong = any_wrong || confidently_wrong(answer, p, truth[p]);
    wrong += any_wrong ? 1U : 0U;
    none += answer.estimates[kFrequencyOf].value ? 0U : 1U;
    unsure += answer.sure[kFrequencyOf] ? 0U : 1U;
  }
  if (static_cast<double>(wrong) > kTolerated * static_cast<double>(trials)) return Mark::Wrong;
  if (2 * none > trials) return Mark::Silent;
  return 2 * unsure > trials ? Mark::Doubtful : Mark::Fine;
}

/// So many of `fit_methods()`, by their place.
std::vector<FitMethod> of_all(const std::vector<std::size_t>& places) {
  std::vector<FitMethod> methods;
  for (const std::size_t i : places) methods.push_back(fit_methods()[i]);
  return methods;
}

/// Those that explain what bends slips, and those that do not.
std::vector<FitMethod> beside_terms() {
  std::vector<FitMethod> methods = of_all({0, 1, 4});
  methods.insert(methods.begin() + 2, fit_without_terms());
  return methods;
}

chart::Chart over(const std::string& title, const Plane& plane, double Factors::*x, double Factors::*y,
                  const std::vector<FitMethod>& methods, std::size_t trials) {
  chart::Chart chart{title, explain_marks({Mark::Silent, Mark::Doubtful, Mark::Wrong}), {}};
  chart.remarks.emplace_back(
      "wrong: more than a tenth of the fits claim a parameter that is 4 standard errors and 2 % off");
  for (const FitMethod& method : methods) {
    chart.panels.push_back(draw_plane(plane, method.look.name, [&](double at_x, double at_y) {
      Factors factors;
      factors.*x = at_x;
      factors.*y = at_y;
      return judge(method, factors, trials);
    }));
  }
  return chart;
}

/// False minima: the start is off, and every cycle adds to the phase that is lost.
chart::Chart false_minima(Effort effort, std::size_t trials) {
  const bool full = effort == Effort::Full;
  const Plane plane{{"relative error of the start values  [-]", log_spaced(1e-4, 0.2, full ? 12 : 6)},
                    {"cycles  [-]", log_spaced(4.0, 200.0, full ? 8 : 4)},
                    230.0,
                    {}};
  chart::Chart chart{"False minima of the fit of a whole trace", explain_marks({Mark::Wrong}), {}};
  chart.remarks.emplace_back("slipfit's fit finds its own start: no axis of this plane exists for it");
  chart.panels.push_back(draw_plane(plane, "whole trace", [&](double start_error, double cycles) {
    const auto run = [start_error](const Factors& factors, std::uint64_t seed) {
      return TimedFit{fit_whole_trace(make_scene(factors, seed), start_error, seed), 0.0};
    };
    Factors factors;
    factors.cycles = cycles;
    return judge({{}, run}, factors, trials);
  }));
  return chart;
}

}  // namespace

std::vector<File> map_fit_failures(Effort effort) {
  const bool full = effort == Effort::Full;
  const std::size_t trials = full ? 12 : 3;
  const PlaneAxis samples{"samples in a slip  [-]", log_spaced(0.5, 50.0, full ? 9 : 4)};
  const PlaneAxis noise{"noise over the drop  [-]", log_spaced(0.002, 0.6, full ? 8 : 4)};
  const PlaneAxis jitter{"scatter of the static friction over the drop  [-]", log_spaced(0.001, 0.3, full ? 9 : 4)};
  const PlaneAxis cycles{"cycles  [-]", log_spaced(6.0, 100.0, full ? 6 : 3)};
  const PlaneAxis hum{"amplitude of the 50 Hz hum over the drop  [-]", log_spaced(0.02, 4.0, full ? 10 : 4)};
  return {{"failures_fit_start.svg", to_svg(false_minima(effort, trials))},
          {"failures_fit_sampling.svg",
           to_svg(over("Where fits fail: few samples and noise", {samples, noise, 200.0, {}},
                       &Factors::samples_per_slip, &Factors::noise, of_all({0, 1, 4}), trials))},
          {"failures_fit_scatter.svg",
           to_svg(over("Where fits fail: scatter and few cycles", {jitter, cycles, 200.0, {}}, &Factors::jitter,
                       &Factors::cycles, of_all({0, 1, 4, 5}), full ? 8 : 2))},
          {"failures_fit_hum.svg", to_svg(over("Where fits fail: hum and noise", {hum, noise, 200.0, {}}, &Factors::hum,
                                               &Factors::noise, of_all({0, 1, 4}), trials))}};
}

std::vector<File> map_term_failures(Effort effort) {
  const bool full = effort == Effort::Full;
  const std::size_t trials = full ? 12 : 3;
  const PlaneAxis noise{"noise over the drop  [-]", log_spaced(0.002, 0.6, full ? 8 : 4)};
  const PlaneAxis average{"average of the sensor times natural frequency  [-]", log_spaced(0.1, 8.0, full ? 10 : 4)};
  const PlaneAxis weakening{"slip distance times stiffness over the drop  [-]", log_spaced(0.01, 0.8, full ? 10 : 4)};
  return {{"failures_fit_average.svg",
           to_svg(over("Where fits fail: an average of the sensor that is not stated", {average, noise, 200.0, {}},
                       &Factors::average, &Factors::noise, beside_terms(), trials))},
          {"failures_fit_weakening.svg",
           to_svg(over("Where fits fail: friction that weakens over a slip distance", {weakening, noise, 200.0, {}},
                       &Factors::weakening, &Factors::noise, beside_terms(), trials))}};
}

}  // namespace atlas
