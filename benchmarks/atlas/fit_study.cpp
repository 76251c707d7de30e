#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fit_methods.hpp"

namespace atlas {
namespace {

using chart::Axis, chart::Panel, chart::Point, chart::Scale;

struct Sweep {
  std::string name;
  std::string label;
  double Factors::*factor;
  std::vector<double> values;
};

std::vector<Sweep> sweeps_of(Effort effort) {
  const std::size_t count = effort == Effort::Full ? 7 : 3;
  return {
      {"noise", "noise, rms over the friction drop  [-]", &Factors::noise, log_spaced(1e-3, 0.3, count)},
      {"jitter", "scatter of the static friction over the drop  [-]", &Factors::jitter, log_spaced(1e-3, 0.3, count)},
      {"samples", "samples in a slip  [-]", &Factors::samples_per_slip, log_spaced(1.0, 60.0, count)},
      {"cycles", "cycles in the recording(s)  [-]", &Factors::cycles, log_spaced(5.0, 150.0, count)}};
}

/// One parameter over the trials of one cell.
struct Score {
  double error = 0.0;   ///< robust, relative
  double excess = 0.0;  ///< the same over the bound
  double covered = 0.0, none = 0.0;
  double wrong = 0.0;  ///< share of the trials: sure, more than 4 standard errors and 2 % off
};

struct Cell {
  std::array<Score, kFitParameters> scores;
  double time_ms = 0.0;
};

Score score_of(const std::vector<FitAnswer>& answers, std::size_t parameter,
               const std::vector<std::array<double, kFitParameters>>& truths, double bound) {
  Score score;
  std::vector<double> errors;
  double intervals = 0.0;
  const double share = 1.0 / static_cast<double>(answers.size());
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const slipfit::Estimate& estimate = answers[i].estimates[parameter];
    const double truth = truths[i][parameter];
    if (estimate.ci95) {
      intervals += 1.0;
      score.covered += truth >= estimate.ci95->low && truth <= estimate.ci95->high ? 1.0 : 0.0;
    }
    if (!estimate.value) {
      score.none += share;
      continue;
    }
    const double error = *estimate.value / truth - 1.0;
    errors.push_back(error);
    const double allowed = std::max(0.02, 4.0 * estimate.standard_error.value_or(0.0) / truth);
    if (answers[i].sure[parameter] && !(std::abs(error) <= allowed)) score.wrong += share;
  }
  score.covered = intervals > 0.0 ? score.covered / intervals : std::nan("");
  score.error = 2.0 * static_cast<double>(errors.size()) >= static_cast<double>(answers.size()) ? robust_size(errors)
                                                                                                : std::nan("");
  score.excess = score.error / bound;
  return score;
}

Cell measure(const FitMethod& method, const Factors& factors, std::size_t trials) {
  std::vector<FitAnswer> answers;
  std::vector<std::array<double, kFitParameters>> truths;
  std::vector<double> times_ms;
  for (std::size_t i = 0; i < trials; ++i) {
    TimedFit fit = method.run(factors, 3000 + i);
    answers.push_back(std::move(fit.answer));
    times_ms.push_back(1e3 * fit.time_s);
    truths.push_back(truth_of(make_scene(factors, 3000 + i)));
  }
  const auto bounds = whole_trace_bound(make_scene(factors, 3000));
  Cell result;
  for (std::size_t p = 0; p < kFitParameters; ++p) {
    result.scores[p] = score_of(answers, p, truths, bounds[p] / truths.front()[p]);
  }
  result.time_ms = median_of(times_ms);
  return result;
}

std::string csv_rows(const std::string& factor, double value, const FitMethod& method, std::size_t trials,
                     const Cell& measured) {
  std::string csv;
  for (std::size_t p = 0; p < kFitParameters; ++p) {
    const Score& s = measured.scores[p];
    csv += fmt::format("{},{:.4g},\"{}\",{},{},{},{},{},{:.3g},{:.3g},{:.4g}\n", factor, value, method.look.name,
                       kFitParameterNames[p], trials, cell(s.error), cell(s.excess), cell(s.covered), s.none, s.wrong,
                       measured.time_ms);
  }
  return csv;
}

Panel panel_over(const Sweep& sweep, const Axis& y) {
  Panel panel;
  panel.height_px = 300.0;
  panel.x = {sweep.label, sweep.values.front(), sweep.values.back(), Scale::Logarithmic};
  panel.y = y;
  return panel;
}

struct Measured {
  std::string csv;
  std::vector<Panel> errors, coverage, wrong;
};

/// What `run_sweep` draws of one sweep.
struct Drawn {
  Panel error, coverage, wrong;
};

Drawn draw_sweep(const Sweep& sweep) {
  return {panel_over(sweep, {"relative error of ωₙ  [-]", 1e-5, 10.0, Scale::Logarithmic}),
          panel_over(sweep, {"coverage of the 95 % interval of ωₙ  [-]", -0.02, 1.02, Scale::Linear}),
          panel_over(sweep, {"share of fits that are confidently wrong  [-]", -0.02, 1.02, Scale::Linear})};
}

void run_sweep(const Sweep& sweep, std::size_t trials, Measured& all) {
  Drawn drawn = draw_sweep(sweep);
  chart::Line bound{"Cramér-Rao bound of the whole trace", chart::Colour::Black, chart::Stroke::Dashed, {}};
  for (const double value : sweep.values) {
    Factors factors;
    factors.*sweep.factor = value;
    const Scene scene = make_scene(factors, 3000);
    bound.points.push_back({value, whole_trace_bound(scene)[kFrequencyOf] / truth_of(scene)[kFrequencyOf]});
  }
  drawn.error.lines.push_back(bound);
  for (const FitMethod& method : fit_methods()) {
    std::vector<Point> errors, coverage, wrong;
    for (const double value : sweep.values) {
      Factors factors;
      factors.*sweep.factor = value;
      const Cell result = measure(method, factors, trials);
      all.csv += csv_rows(sweep.name, value, method, trials, result);
      errors.push_back({value, result.scores[kFrequencyOf].error});
      coverage.push_back({value, result.scores[kFrequencyOf].covered});
      wrong.push_back(
          {value, std::max_element(result.scores.begin(), result.scores.end(), [](const Score& a, const Score& b) {
                    return a.wrong < b.wrong;
                  })->wrong});
    }
    add_series(drawn.error, method.look, errors);
    add_series(drawn.coverage, method.look, coverage);
    add_series(drawn.wrong, method.look, wrong);
  }
  for (const auto& [panels, panel] : {std::pair{&all.errors, &drawn.error}, std::pair{&all.coverage, &drawn.coverage},
                                      std::pair{&all.wrong, &drawn.wrong}}) {
    if (!panels->empty()) strip_legend(*panel);
    panels->push_back(*panel);
  }
}

/// Error over the bound against time, for each of three parameters.
std::vector<Panel> time_panels(std::size_t trials) {
  constexpr std::array<std::pair<FitParameter, const char*>, 3> kShown{
      {{kFrequencyOf, "error of ωₙ over the bound  [-]"},
       {kDropOf, "error of Fₛ − Fₖ over the bound  [-]"},
       {kStiffnessOf, "error of k over the bound  [-]"}}};
  std::vector<Panel> panels(kShown.size());
  std::vector<std::vector<Point>> usual(kShown.size());
  for (const FitMethod& method : fit_methods()) {
    std::vector<std::vector<Point>> points(kShown.size());
    for (const double cycles : {10.0, 40.0, 160.0}) {
      Factors factors;
      factors.cycles = cycles;
      const Cell result = measure(method, factors, trials);
      for (std::size_t i = 0; i < kShown.size(); ++i) {
        points[i].push_back({result.time_ms, result.scores[kShown[i].first].excess});
        if (cycles == 40.0 && std::isfinite(points[i].back().y)) usual[i].push_back(points[i].back());
      }
    }
    for (std::size_t i = 0; i < kShown.size(); ++i) add_series(panels[i], method.look, points[i]);
  }
  for (std::size_t i = 0; i < kShown.size(); ++i) {
    panels[i].height_px = 330.0;
    panels[i].x = {"CPU time of the fit  [ms]", 0.1, 100.0, Scale::Logarithmic};
    panels[i].y = {kShown[i].second, 0.1, 3e3, Scale::Logarithmic};
    panels[i].lines.push_back(draw_front(usual[i], 100.0));
    if (i > 0) strip_legend(panels[i]);
  }
  return panels;
}

}  // namespace

std::vector<File> study_fits(Effort effort) {
  const std::size_t trials = effort == Effort::Full ? 16 : 3;
  Measured all;
  for (const Sweep& sweep : sweeps_of(effort)) run_sweep(sweep, trials, all);
  const std::string usual = "Usual: 40 cycles, 20 samples per slip, noise 0.02 of the friction drop, no scatter.";
  const chart::Chart time{"Fits: error over the bound against time",
                          {"Three markers a method: 10, 40 and 160 cycles; the front is that of 40 cycles.", usual,
                           "Bound: white noise, all samples of the one recording at the usual speed."},
                          time_panels(trials)};
  const chart::Chart errors{
      "Fits: error of the natural frequency",
      {usual, "Robust size (68 %) of the errors; no mark: no value in more than half of the trials."},
      all.errors};
  const chart::Chart coverage{"Fits: how often the 95 % interval holds the truth", {usual}, all.coverage};
  const chart::Chart wrong{"Fits: confidently wrong",
                           {usual, "Share of fits that claim to know, and are more than 4 standard errors and 2 % off,",
                            "for the parameter where that share is largest."},
                           all.wrong};
  return {{"fit.csv",
           "factor,value,method,parameter,trials,relative_error,error_over_bound,coverage,share_none,"
           "share_confidently_wrong,median_cpu_ms\n" +
               all.csv},
          {"fit_time.svg", to_svg(time)},
          {"fit_factors.svg", to_svg(errors)},
          {"fit_coverage.svg", to_svg(coverage)},
          {"fit_wrong.svg", to_svg(wrong)}};
}

}  // namespace atlas
