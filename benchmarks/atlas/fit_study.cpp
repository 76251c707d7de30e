#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fit_methods.hpp"

namespace atlas {
namespace {

std::vector<FactorSweep> sweeps_of(Effort effort) {
  const std::size_t count = effort == Effort::Full ? 7 : 3;
  return {{"noise", &Factors::noise, log_spaced(1e-3, 0.3, count)},
          {"jitter", &Factors::jitter, log_spaced(1e-3, 0.3, count)},
          {"samples", &Factors::samples_per_slip, log_spaced(1.0, 60.0, count)},
          {"cycles", &Factors::cycles, log_spaced(5.0, 150.0, count)}};
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
    if (is_confidently_wrong(answers[i], parameter, truth)) score.wrong += share;
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
    csv += fmt::format("{},{:.4g},\"{}\",{},{},{},{},{},{:.3g},{:.3g},{:.4g}\n", factor, value, method.name,
                       kFitParameterNames[p], trials, cell(s.error), cell(s.excess), cell(s.covered), s.none, s.wrong,
                       measured.time_ms);
  }
  return csv;
}

}  // namespace

std::vector<File> study_fits(Effort effort) {
  const std::size_t trials = effort == Effort::Full ? 16 : 3;
  std::string csv =
      "factor,value,method,parameter,trials,relative_error,error_over_bound,coverage,share_none,"
      "share_confidently_wrong,median_cpu_ms\n";
  std::vector<FactorSweep> sweeps = sweeps_of(effort);
  sweeps.push_back({"time", &Factors::cycles, {10.0, 40.0, 160.0}});  // error over the bound against time
  for (const FactorSweep& sweep : sweeps) {
    for (const FitMethod& method : fit_methods()) {
      for (const double value : sweep.values) {
        csv += csv_rows(sweep.name, value, method, trials, measure(method, sweep.at(value), trials));
      }
    }
  }
  return {{"fit.csv", csv}};
}

}  // namespace atlas
