#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "forward_methods.hpp"

namespace atlas {
namespace {

constexpr std::size_t kSamples = 200;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kRoundOff = 1e-16;  // the least error that is written: a logarithmic axis has no 0

struct Row {
  ForwardScene scene;
  const ForwardMethod* method = nullptr;
  Outcome expected = Outcome::NoCycle, outcome = Outcome::GaveUp;
  double period_error = kNone, wave_error = kNone, time_s = kNone;
};

/// Friction that weakens (alpha V < 0) by 0.3 or strengthens by 0.05 of F_s - F_k at most over the speeds of a slip.
std::vector<ForwardScene> scenes_of(Effort effort) {
  const bool full = effort == Effort::Full;
  const std::vector<double> lambdas =
      full ? std::vector<double>{0.5, 1, 2, 5, 10, 20, 50, 100} : std::vector<double>{1, 5, 20};
  const std::vector<double> zetas =
      full ? std::vector<double>{0, 0.005, 0.02, 0.05, 0.1, 0.2} : std::vector<double>{0.02, 0.1};
  std::vector<ForwardScene> scenes;
  for (const double lambda : lambdas) {
    for (const double zeta : zetas) {
      scenes.push_back({lambda, zeta, 0.0, 0.0});
      for (const double rate : {-1.0, -0.1, -0.01}) scenes.push_back({lambda, zeta, 0.3 * lambda * rate, rate});
      const double rate = 0.5 / lambda;
      scenes.push_back({lambda, zeta, 0.05 * lambda * rate, rate});
    }
  }
  return scenes;
}

double wave_error(const std::vector<double>& z, const std::vector<double>& truth) {
  double error = 0.0;
  double size = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    error += (z[i] - truth[i]) * (z[i] - truth[i]);
    size += truth[i] * truth[i];
  }
  return std::sqrt(error / size);
}

Row measure(const ForwardScene& scene, const ForwardMethod& method, const Reference& reference, Effort effort) {
  const Answer answer = method.run(scene, reference.times);
  Row row{scene, &method, reference.answer.outcome, answer.outcome, kNone, kNone, kNone};
  if (answer.outcome == Outcome::Cycle && row.expected == Outcome::Cycle) {
    row.period_error = std::max(kRoundOff, std::abs(answer.period / reference.answer.period - 1.0));
    row.wave_error = std::max(kRoundOff, wave_error(answer.z, reference.answer.z));
    row.time_s = time_call_s([&] { (void)method.run(scene, reference.times); }, effort == Effort::Full ? 7 : 3);
  }
  return row;
}

using Choice = std::function<bool(const ForwardScene&)>;

struct Summary {
  const ForwardMethod* method = nullptr;
  double time_us = kNone, period_error = kNone, worst_period_error = kNone, wave_error = kNone;
  std::size_t scenes = 0, wrong = 0;
};

std::vector<Summary> summarise(const std::vector<Row>& rows, const std::vector<ForwardMethod>& methods,
                               const Choice& choice) {
  std::vector<Summary> summaries;
  for (const ForwardMethod& method : methods) {
    std::vector<double> times, periods, waves;
    Summary summary{&method, kNone, kNone, kNone, kNone, 0, 0};
    for (const Row& row : rows) {
      if (row.method != &method || !choice(row.scene)) continue;
      ++summary.scenes;
      summary.wrong += row.outcome != row.expected ? 1U : 0U;
      if (!std::isfinite(row.time_s)) continue;
      times.push_back(1e6 * row.time_s);
      periods.push_back(row.period_error);
      waves.push_back(row.wave_error);
    }
    summary.time_us = median_of(times);
    summary.period_error = median_of(periods);
    if (!periods.empty()) summary.worst_period_error = *std::max_element(periods.begin(), periods.end());
    summary.wave_error = median_of(waves);
    summaries.push_back(summary);
  }
  return summaries;
}

std::string summary_csv(const std::vector<std::pair<std::string, std::vector<Summary>>>& groups) {
  std::string csv =
      "friction,method,setting,scenes,wrong_or_gave_up,median_cpu_us,median_period_error,largest_period_error,median_"
      "waveform_error\n";
  for (const auto& [name, summaries] : groups) {
    for (const Summary& s : summaries) {
      csv +=
          fmt::format("{},\"{}\",{},{},{},{},{},{},{}\n", name, s.method->family, s.method->setting, s.scenes, s.wrong,
                      cell(s.time_us), cell(s.period_error), cell(s.worst_period_error), cell(s.wave_error));
    }
  }
  return csv;
}

/// Error of the period against lambda at zeta 0.05, one setting a family.
std::string lambda_csv(Effort effort) {
  const std::map<std::string, std::string> settings{{"RK4, sign switching", "0.01"},
                                                    {"time stepping (Moreau)", "0.01"},
                                                    {"ODE 5(4), event location", "1e-07"},
                                                    {"switch model (Leine)", "0.0001"},
                                                    {"tanh-smoothed", "0.001"}};
  std::string csv = "method,setting,lambda,period_error\n";
  for (const ForwardMethod& method : forward_methods()) {
    const auto setting = settings.find(method.family);
    if (!method.setting.empty() && (setting == settings.end() || setting->second != method.setting)) continue;
    for (const double lambda : log_spaced(0.3, 300.0, effort == Effort::Full ? 19 : 6)) {
      const ForwardScene scene{lambda, 0.05, 0.0, 0.0};
      const Reference reference = solve_reference(scene, kSamples);
      const Answer answer = method.run(scene, reference.times);
      if (answer.outcome != Outcome::Cycle || reference.answer.outcome != Outcome::Cycle) continue;
      const double error = std::max(kRoundOff, std::abs(answer.period / reference.answer.period - 1.0));
      csv += fmt::format("\"{}\",{},{:.6g},{:.6g}\n", method.family, method.setting, lambda, error);
    }
  }
  return csv;
}

}  // namespace

std::vector<File> study_forward(Effort effort) {
  const std::vector<ForwardMethod> methods = forward_methods();
  std::vector<Row> rows;
  for (const ForwardScene& scene : scenes_of(effort)) {
    const Reference reference = solve_reference(scene, kSamples);
    for (const ForwardMethod& method : methods) rows.push_back(measure(scene, method, reference, effort));
  }
  const auto coulomb = summarise(rows, methods, [](const ForwardScene& s) { return s.rate == 0.0; });
  const auto speed = summarise(rows, methods, [](const ForwardScene& s) { return s.rate != 0.0; });
  return {{"forward.csv", summary_csv({{"constant", coulomb}, {"of_speed", speed}})},
          {"forward_lambda.csv", lambda_csv(effort)}};
}

}  // namespace atlas
