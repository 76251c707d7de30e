#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "frequency_methods.hpp"
#include "scenes.hpp"
#include "support/waveform.hpp"

namespace atlas {
namespace {

using chart::Panel, chart::Point, chart::Scale;

constexpr double kGross = 0.05;  // relative error beyond which it is another frequency
constexpr double kLeast = 1e-7;  // axes of errors begin here

/// One factor varied, the others as usual.
struct Sweep {
  std::string name;
  std::string label;
  double Factors::*factor;
  std::vector<double> values;
};

std::vector<Sweep> sweeps_of(Effort effort) {
  const std::size_t count = effort == Effort::Full ? 11 : 5;
  return {
      {"noise", "noise, rms over the friction drop  [-]", &Factors::noise, log_spaced(1e-3, 3.0, count)},
      {"jitter", "scatter of the static friction over the drop  [-]", &Factors::jitter, log_spaced(1e-3, 0.3, count)},
      {"drift", "drift over the recording, in drops  [-]", &Factors::drift, log_spaced(0.1, 100.0, count)},
      {"hum", "amplitude of the 50 Hz hum over the drop  [-]", &Factors::hum, log_spaced(0.01, 3.0, count)},
      {"cycles", "cycles in the recording  [-]", &Factors::cycles, log_spaced(4.0, 400.0, count)}};
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

Panel error_panel(const Sweep& sweep) {
  Panel panel;
  panel.height_px = 360.0;
  panel.x = {sweep.label, sweep.values.front(), sweep.values.back(), Scale::Logarithmic};
  panel.y = {"relative error of the frequency  [-]", kLeast, 10.0, Scale::Logarithmic};
  return panel;
}

struct Measured {
  std::string csv;
  std::vector<Panel> panels;
};

Measured run_sweeps(Effort effort, std::size_t trials) {
  Measured all;
  for (const Sweep& sweep : sweeps_of(effort)) {
    Panel panel = error_panel(sweep);
    chart::Line bound{"Cramér-Rao bound and scatter of the periods", chart::Colour::Black, chart::Stroke::Dashed, {}};
    std::vector<std::vector<Point>> points(frequency_methods().size());
    for (const double value : sweep.values) {
      Factors factors;
      factors.*sweep.factor = value;
      const double least = bound_of(make_scene(factors, 1000), factors);
      bound.points.push_back({value, least});
      std::size_t column = 0;
      for (const FrequencyMethod& method : frequency_methods()) {
        const Cell result = measure(method, factors, trials);
        points[column++].push_back({value, result.error});
        all.csv +=
            fmt::format("{},{:.4g},\"{}\",{},{},{:.3g},{:.3g},{:.4g},{:.4g}\n", sweep.name, value, method.look.name,
                        trials, cell(result.error), result.none, result.gross, least, result.time_us);
      }
    }
    panel.lines.push_back(bound);
    for (std::size_t i = 0; i < points.size(); ++i) add_series(panel, frequency_methods()[i].look, points[i]);
    if (!all.panels.empty()) strip_legend(panel);
    all.panels.push_back(std::move(panel));
  }
  return all;
}

Panel time_panel(Effort effort, std::size_t trials) {
  Panel panel;
  panel.height_px = 400.0;
  panel.x = {"CPU time for one recording of 40 cycles, about 4000 samples  [µs]", 20.0, 1e6, Scale::Logarithmic};
  panel.y = {"relative error of the frequency  [-]", 1e-7, 1.0, Scale::Logarithmic};
  const std::vector<std::pair<double, std::string>> noises{{0.002, "0.002"}, {0.02, "0.02"}, {0.2, "0.2"}};
  std::vector<Point> usual;
  for (const FrequencyMethod& method : frequency_methods()) {
    std::vector<Point> points;
    for (const auto& [noise, text] : noises) {
      Factors factors;
      factors.noise = noise;
      const Cell result = measure(method, factors, effort == Effort::Full ? 2 * trials : trials);
      points.push_back({result.time_us, result.error});
      if (noise == 0.02) usual.push_back(points.back());
    }
    add_series(panel, method.look, points);
  }
  panel.lines.push_back(draw_front(usual, 1e6));
  return panel;
}

}  // namespace

std::vector<File> study_frequency(Effort effort) {
  const std::size_t trials = effort == Effort::Full ? 40 : 9;
  const Measured all = run_sweeps(effort, trials);
  const chart::Chart time{
      "Frequency: error against time",
      {"Three markers a method: noise of 0.2 (top), 0.02 and 0.002 of the friction drop; 40 cycles.",
       "The front is that of the middle noise."},
      {time_panel(effort, trials)}};
  const chart::Chart factors{
      "Frequency: error against what spoils a recording",
      {"Usual: 40 cycles, 20 samples per slip, noise 0.02 of the friction drop, nothing else.",
       "Robust size (68 %) of the errors; no mark: it finds none in more than half of the trials."},
      all.panels};
  return {{"frequency.csv",
           "factor,value,method,trials,relative_error,share_none,share_gross,bound,median_cpu_us\n" + all.csv},
          {"frequency_time.svg", to_svg(time)},
          {"frequency_factors.svg", to_svg(factors)}};
}

}  // namespace atlas
