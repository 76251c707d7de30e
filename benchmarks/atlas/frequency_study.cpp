#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "frequency_methods.hpp"
#include "scenes.hpp"
#include "support/waveform.hpp"

namespace atlas {
namespace {

constexpr double kGross = 0.05;  // relative error beyond which it is another frequency
constexpr double kLeast = 1e-7;  // the least error that is written

std::vector<FactorSweep> sweeps_of(Effort effort) {
  const std::size_t count = effort == Effort::Full ? 11 : 5;
  return {{"noise", &Factors::noise, log_spaced(1e-3, 3.0, count)},
          {"jitter", &Factors::jitter, log_spaced(1e-3, 0.3, count)},
          {"drift", &Factors::drift, log_spaced(0.1, 100.0, count)},
          {"hum", &Factors::hum, log_spaced(0.01, 3.0, count)},
          {"cycles", &Factors::cycles, log_spaced(4.0, 400.0, count)}};
}

/// Cramer-Rao bound of the relative error of the frequency for a waveform of known shape in white noise, and what
/// scatter of the periods leaves: the two as independent.
double bound_of(const Scene& scene, const Factors& factors) {
  const slipfit::Recording& recording = scene.recording;
  const double step_s = recording.duration_s() / static_cast<double>(recording.size() - 1);
  const auto force = slipfit::damped_waveform(scene.slider, scene.friction, recording.conditions().speed_m_per_s,
                                              slipfit::ForceView::Spring, {0.0, step_s, recording.size()});
  double square = 0.0;  // of the slope a cycle
  for (std::size_t i = 1; i < force->size(); ++i) {
    square += std::pow(((*force)[i] - (*force)[i - 1]) / step_s * scene.cycle.period_s, 2);
  }
  const auto samples = static_cast<double>(recording.size());
  const double cycles = recording.duration_s() / scene.cycle.period_s;
  const double white =
      scene.noise_N * std::sqrt(12.0 / (square * cycles * cycles)) * std::sqrt(samples / (samples - 1));
  return std::hypot(white, factors.jitter * period_by_friction(scene) / std::sqrt(cycles));
}

struct Cell {
  double error = 0.0;  ///< robust, relative
  double time_us = 0.0;
  double none = 0.0;   ///< share that says "no frequency"
  double gross = 0.0;  ///< share with a number that is off by more than kGross
};

Cell measure(const FrequencyMethod& method, const Factors& factors, std::size_t trials) {
  Cell result;
  std::vector<double> errors;
  std::vector<double> times_us;
  for (std::size_t i = 0; i < trials; ++i) {
    const Scene scene = make_scene(factors, 1000 + i);
    const double start_s = cpu_now_s();
    const std::optional<double> found_Hz = method.find(scene.recording).value;
    times_us.push_back(1e6 * (cpu_now_s() - start_s));
    if (!found_Hz) {
      result.none += 1.0 / static_cast<double>(trials);
      continue;
    }
    errors.push_back(*found_Hz * scene.cycle.period_s - 1.0);
    if (std::abs(errors.back()) > kGross) result.gross += 1.0 / static_cast<double>(trials);
  }
  result.error = std::max(kLeast, robust_size(errors));
  if (result.none > 0.5) result.error = std::nan("");
  result.time_us = median_of(times_us);
  return result;
}

std::string row(const std::string& factor, double value, const FrequencyMethod& method, std::size_t trials,
                const Cell& result, double bound) {
  return fmt::format("{},{:.4g},\"{}\",{},{},{:.3g},{:.3g},{:.4g},{:.4g}\n", factor, value, method.name, trials,
                     cell(result.error), result.none, result.gross, bound, result.time_us);
}

}  // namespace

std::vector<File> study_frequency(Effort effort) {
  const std::size_t trials = effort == Effort::Full ? 40 : 9;
  const std::size_t timed_trials = effort == Effort::Full ? 2 * trials : trials;
  std::string csv = "factor,value,method,trials,relative_error,share_none,share_gross,bound,median_cpu_us\n";
  for (const FactorSweep& sweep : sweeps_of(effort)) {
    for (const double value : sweep.values) {
      const Factors factors = sweep.at(value);
      const double bound = bound_of(make_scene(factors, 1000), factors);
      for (const FrequencyMethod& method : frequency_methods()) {
        csv += row(sweep.name, value, method, trials, measure(method, factors, trials), bound);
      }
    }
  }
  for (const FrequencyMethod& method : frequency_methods()) {  // error against time
    for (const double noise : {0.002, 0.02, 0.2}) {
      Factors factors;
      factors.noise = noise;
      const double bound = bound_of(make_scene(factors, 1000), factors);
      csv += row("time", noise, method, timed_trials, measure(method, factors, timed_trials), bound);
    }
  }
  return {{"frequency.csv", csv}};
}

}  // namespace atlas
