#include <algorithm>
#include <cmath>

#include "failure_plane.hpp"
#include "fit_methods.hpp"

namespace atlas {
namespace {

constexpr double kTolerated = 0.11;  // share of wrong trials below which a cell is called right

Mark judge(const FitMethod& method, const Factors& factors, std::size_t trials) {
  std::size_t none = 0, unsure = 0, wrong = 0;
  for (std::size_t i = 0; i < trials; ++i) {
    const FitAnswer answer = method.run(factors, 7000 + i).answer;
    const auto truth = truth_of(make_scene(factors, 7000 + i));
    bool any_wrong = false;
    for (std::size_t p = 0; p < kFitParameters; ++p) any_wrong = any_wrong || is_confidently_wrong(answer, p, truth[p]);
    wrong += any_wrong ? 1U : 0U;
    none += answer.estimates[kFrequencyOf].value ? 0U : 1U;
    unsure += answer.sure[kFrequencyOf] ? 0U : 1U;
  }
  if (static_cast<double>(wrong) > kTolerated * static_cast<double>(trials)) return Mark::Wrong;
  if (2 * none > trials) return Mark::Refused;
  return 2 * unsure > trials ? Mark::Weak : Mark::Right;
}

/// The entries of `fit_methods()` at these places.
std::vector<FitMethod> of_all(const std::vector<std::size_t>& places) {
  std::vector<FitMethod> methods;
  for (const std::size_t i : places) methods.push_back(fit_methods()[i]);
  return methods;
}

/// Methods with and without the terms that distort slips.
std::vector<FitMethod> methods_with_and_without_terms() {
  std::vector<FitMethod> methods = of_all({0, 1, 4});
  methods.insert(methods.begin() + 2, fit_without_terms());
  return methods;
}

std::string over(const Plane& plane, double Factors::*x, double Factors::*y, const std::vector<FitMethod>& methods,
                 std::size_t trials) {
  std::string rows;
  for (const FitMethod& method : methods) {
    rows +=
        judge_factors(plane, method.name, x, y, [&](const Factors& factors) { return judge(method, factors, trials); });
  }
  return rows;
}

/// Whole-trace fits from starting values that are off; every cycle adds to the error of the phase. slipfit finds its
/// own start, so that it answers alike along the axis of the start error.
std::string false_minima(Effort effort, std::size_t trials) {
  const bool full = effort == Effort::Full;
  const Plane plane{"fit_start", log_spaced(1e-4, 0.2, full ? 12 : 6), log_spaced(4.0, 200.0, full ? 8 : 4)};
  const auto judged = [&](const FitMethod& method, double cycles) {
    Factors factors;
    factors.cycles = cycles;
    return judge(method, factors, trials);
  };
  std::string rows = judge_plane(plane, "whole trace", [&](double start_error, double cycles) {
    const auto run = [start_error](const Factors& factors, std::uint64_t seed) {
      return TimedFit{fit_whole_trace(make_scene(factors, seed), start_error, seed), 0.0};
    };
    return judged({{}, run}, cycles);
  });
  const FitMethod blocks = fit_methods()[4];
  std::vector<Mark> own;
  for (const double cycles : plane.y) own.push_back(judged(blocks, cycles));
  return rows + judge_plane(plane, blocks.name, [&](double, double cycles) {
           const auto at = std::find(plane.y.begin(), plane.y.end(), cycles);
           return own[static_cast<std::size_t>(at - plane.y.begin())];
         });
}

}  // namespace

std::string map_fit_failures(Effort effort) {
  const bool full = effort == Effort::Full;
  const std::size_t trials = full ? 12 : 3;
  const std::vector<double> noise = log_spaced(0.002, 0.6, full ? 8 : 4);  // over the friction drop
  const std::vector<double> jitter = log_spaced(0.001, 0.3, full ? 9 : 4);
  return false_minima(effort, trials) +
         over({"fit_sampling", log_spaced(0.5, 50.0, full ? 9 : 4), noise}, &Factors::samples_per_slip, &Factors::noise,
              of_all({0, 1, 4}), trials) +
         over({"fit_scatter", jitter, log_spaced(6.0, 100.0, full ? 6 : 3)}, &Factors::jitter, &Factors::cycles,
              of_all({0, 1, 4, 5}), full ? 8 : 2) +
         over({"fit_hum", log_spaced(0.02, 4.0, full ? 10 : 4), noise}, &Factors::hum, &Factors::noise,
              of_all({0, 1, 4}), trials);
}

std::vector<File> map_term_failures(Effort effort) {
  const bool full = effort == Effort::Full;
  const std::size_t trials = full ? 12 : 3;
  const std::vector<double> noise = log_spaced(0.002, 0.6, full ? 8 : 4);
  const std::vector<FitMethod> methods = methods_with_and_without_terms();
  return {{"failures_terms.csv", failure_columns() +
                                     over({"fit_average", log_spaced(0.1, 8.0, full ? 10 : 4), noise},
                                          &Factors::average, &Factors::noise, methods, trials) +
                                     over({"fit_weakening", log_spaced(0.01, 0.8, full ? 10 : 4), noise},
                                          &Factors::weakening, &Factors::noise, methods, trials)}};
}

}  // namespace atlas
