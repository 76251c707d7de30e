// Simulates speed sweeps of known truth, fits each jointly, and counts how often the truth lies in the intervals; then
// what the three lower speeds predict for the two higher ones. docs/validation.md quotes what it prints.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <deque>
#include <fstream>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "fit/sweep/sweep_solution.hpp"
#include "sweeps.hpp"

namespace {

using sweep_coverage::Sweep;
using sweep_coverage::Truth;

struct Row {
  std::uint64_t seed = 0;
  std::string family, quantity, status;
  double truth = 0.0;
  slipfit::Estimate estimate;

  [[nodiscard]] bool covered() const {
    return estimate.ci95 && truth >= estimate.ci95->low && truth <= estimate.ci95->high;
  }
  [[nodiscard]] double relative_error() const { return std::abs(*estimate.value / truth - 1.0); }
  [[nodiscard]] bool confidently_wrong() const {
    const double miss = std::abs(*estimate.value - truth);
    return status == "identified" && miss > 4.0 * estimate.standard_error.value_or(0.0) && relative_error() > 0.02;
  }
};

std::map<std::string, double> truths_of(const Truth& truth) {
  return {{"stiffness_N_per_m", truth.stiffness_N_per_m},
          {"natural_frequency_rad_per_s", truth.natural_frequency_rad_per_s},
          {"damping_ratio", truth.damping_ratio},
          {"friction_difference_N", truth.friction_difference_N()},
          {"static_friction_N", truth.static_friction_N},
          {"kinetic_friction_N", truth.kinetic_friction_N()},
          {"alpha_s_per_m", truth.alpha_s_per_m},
          {"f0_N", truth.f0_N},
          {"f1_N", truth.f1_N}};
}

/// Spacing at the two highest speeds from a fit of the three lowest.
void add_predictions(const Sweep& sweep, const std::string& family, std::vector<Row>& rows) {
  constexpr std::size_t kFitted = 3;
  const std::size_t speeds = sweep.entries.size();
  std::vector<slipfit::Quality> qualities(speeds);
  std::vector<slipfit::Segmentation> slips(speeds);
  std::vector<slipfit::SweepRecording> recordings;
  for (std::size_t i = 0; i < speeds; ++i) {
    const slipfit::Recording& recording = sweep.entries[i].recording;
    qualities[i] = slipfit::assess_quality(recording);
    slips[i] = slipfit::find_slips(recording, qualities[i]);
    recordings.push_back(
        {recording, qualities[i], slips[i], i < kFitted ? slipfit::SweepRole::Cycles : slipfit::SweepRole::LeftOut});
  }
  const auto fit = slipfit::fit_sweep(recordings, {});
  for (std::size_t i = kFitted; fit && i < speeds; ++i) {
    const auto truth = sweep.truth.spacing_m(sweep.entries[i].recording.conditions().speed_m_per_s);
    const slipfit::Estimate& spacing = fit->points[i].spacing_m;
    if (truth && spacing.value) rows.push_back({sweep.seed, family, "spacing_beyond_m", "predicted", *truth, spacing});
  }
}

std::vector<Row> study(std::uint64_t seed) {
  static const std::map<slipfit::ParameterStatus, std::string> kStatus{
      {slipfit::ParameterStatus::Identified, "identified"}, {slipfit::ParameterStatus::Weak, "weak"},
      {slipfit::ParameterStatus::Bounded, "bounded"},       {slipfit::ParameterStatus::Unidentified, "unidentified"},
      {slipfit::ParameterStatus::Fixed, "fixed"},           {slipfit::ParameterStatus::Conditional, "conditional"}};
  const Sweep sweep = sweep_coverage::make_sweep(seed);
  const std::string family = sweep.truth.alpha_s_per_m < 0.0 ? "alpha<0" : "alpha>0";
  const slipfit::SweepAnalysis analysis = slipfit::analyze_sweep(sweep.entries);
  std::vector<Row> rows;
  if (!analysis.fit) return rows;
  const std::map<std::string, double> truths = truths_of(sweep.truth);
  for (const slipfit::Parameter& parameter : analysis.fit->result.parameters) {
    const auto truth = truths.find(std::string(parameter.name()));
    if (truth == truths.end() || !parameter.estimate.value) continue;
    rows.push_back(
        {seed, family, std::string(parameter.name()), kStatus.at(parameter.status), truth->second, parameter.estimate});
  }
  for (std::size_t i = 0; i < sweep.entries.size(); ++i) {
    const auto truth = sweep.truth.spacing_m(sweep.entries[i].recording.conditions().speed_m_per_s);
    const slipfit::Estimate& spacing = analysis.fit->points[i].spacing_left_out_m;
    if (truth && spacing.value) rows.push_back({seed, family, "spacing_left_out_m", "predicted", *truth, spacing});
  }
  add_predictions(sweep, family, rows);
  return rows;
}

std::string summarise(const std::vector<Row>& rows) {
  std::map<std::pair<std::string, std::string>, std::vector<const Row*>> groups;
  for (const Row& row : rows) groups[{row.quantity, row.family}].push_back(&row);
  std::string text = fmt::format("{:28} {:8} {:>5} {:>8} {:>7} {:>9} {:>9} {:>10} {:>5}\n", "quantity", "family", "n",
                                 "covered", "z sd", "med err", "p95 err", "identified", "wrong");
  for (const auto& [name, group] : groups) {
    const auto count = static_cast<double>(group.size());
    double covered = 0.0;
    double square = 0.0;
    std::size_t identified = 0;
    std::size_t wrong = 0;
    std::vector<double> errors;
    for (const Row* row : group) {
      covered += row->covered() ? 1.0 : 0.0;
      const double z = (*row->estimate.value - row->truth) / row->estimate.standard_error.value_or(1.0);
      square += z * z;
      identified += row->status == "identified" ? 1U : 0U;
      wrong += row->confidently_wrong() ? 1U : 0U;
      errors.push_back(row->relative_error());
    }
    std::sort(errors.begin(), errors.end());
    text += fmt::format("{:28} {:8} {:5} {:7.1f}% {:7.2f} {:9.4f} {:9.4f} {:10} {:5}\n", name.first, name.second,
                        group.size(), 100.0 * covered / count, std::sqrt(square / count), errors[errors.size() / 2],
                        errors[errors.size() * 95 / 100], identified, wrong);
  }
  return text;
}

std::string to_csv(const std::vector<Row>& rows) {
  std::string csv = "seed,family,quantity,status,truth,value,se,low,high\n";
  for (const Row& row : rows) {
    const slipfit::Interval ci = row.estimate.ci95.value_or(slipfit::Interval{});
    csv +=
        fmt::format("{},{},{},{},{:.8g},{:.8g},{:.4g},{:.8g},{:.8g}\n", row.seed, row.family, row.quantity, row.status,
                    row.truth, *row.estimate.value, row.estimate.standard_error.value_or(0.0), ci.low, ci.high);
  }
  return csv;
}

/// One joint fit with alpha, from the recordings' own fits on.
double seconds_of_one_fit(const Sweep& sweep) {
  using namespace slipfit;
  std::deque<Quality> qualities;
  std::deque<Segmentation> slips;
  std::vector<SweepRecording> recordings;
  for (const SweepEntry& entry : sweep.entries) {
    qualities.push_back(assess_quality(entry.recording));
    slips.push_back(find_slips(entry.recording, qualities.back()));
    recordings.push_back({entry.recording, qualities.back(), slips.back(), SweepRole::Cycles});
  }
  const fit::SweepData data = fit::prepare_sweep(recordings, {});
  const std::optional<fit::SweepFits> fits = fit::solve_sweep(data, {});
  const auto start = std::chrono::steady_clock::now();
  fit::with_rate(fits->velocity, -1.0);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Five recordings of 20 000 samples and 50 cycles: all that `fit --joint` does (each recording alone, the fit of the
/// sweep from several starts, the fits without each recording).
void time_fit() {
  constexpr std::size_t kRepeats = 5;
  const Sweep sweep = sweep_coverage::make_sweep(4, sweep_coverage::Size{50.0, 25.0, 20000});
  std::vector<double> alone_s;
  std::vector<double> whole_s;
  const auto seconds = [](auto start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  for (std::size_t i = 0; i < kRepeats; ++i) {
    auto start = std::chrono::steady_clock::now();
    for (const auto& entry : sweep.entries) (void)slipfit::analyze_and_fit(entry.recording);
    alone_s.push_back(seconds(start));
    start = std::chrono::steady_clock::now();
    (void)slipfit::analyze_sweep(sweep.entries);
    whole_s.push_back(seconds(start));
  }
  std::sort(alone_s.begin(), alone_s.end());
  std::sort(whole_s.begin(), whole_s.end());
  fmt::print("samples");
  for (const auto& entry : sweep.entries) fmt::print(" {}", entry.recording.size());
  fmt::print(": one by one {:.1f} ms, with the fit of the sweep {:.1f} ms (median of {})\n",
             1e3 * alone_s[kRepeats / 2], 1e3 * whole_s[kRepeats / 2], kRepeats);
  std::vector<double> once_s;
  for (std::size_t i = 0; i < kRepeats; ++i) once_s.push_back(seconds_of_one_fit(sweep));
  std::sort(once_s.begin(), once_s.end());
  fmt::print("one joint fit alone, from one start: {:.1f} ms\n", 1e3 * once_s[kRepeats / 2]);
}

}  // namespace

int main(int argc, char** argv) {
  std::uint64_t count = 100;
  std::uint64_t seed = 1;
  unsigned jobs = 2;
  std::string out;
  bool timing = false;
  CLI::App program("Coverage of the intervals of fits of sweeps over simulated speed sweeps");
  program.add_option("--count", count, "Sweeps")->capture_default_str();
  program.add_option("--seed", seed, "First seed")->capture_default_str();
  program.add_option("--jobs", jobs, "Threads")->capture_default_str();
  program.add_option("--out", out, "Write one row a sweep and quantity (CSV)");
  program.add_flag("--timing", timing, "Only time one large joint fit");
  CLI11_PARSE(program, argc, argv);
  if (timing) {
    time_fit();
    return 0;
  }
  std::vector<std::vector<Row>> results(count);
  std::atomic<std::uint64_t> next{0};
  const auto work = [&] {
    for (std::uint64_t i = next++; i < count; i = next++) results[i] = study(seed + i);
  };
  std::vector<std::thread> threads;
  for (unsigned i = 0; i < std::max(1U, jobs); ++i) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  std::vector<Row> rows;
  for (const auto& result : results) rows.insert(rows.end(), result.begin(), result.end());
  if (!out.empty()) std::ofstream(out) << to_csv(rows);
  fmt::print("{}", summarise(rows));
}
