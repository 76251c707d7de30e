#include "tally.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <deque>
#include <map>
#include <set>
#include <sstream>
#include <tuple>
#include <utility>

namespace coverage {
namespace {

using slipfit::Analysis;
using slipfit::Estimate;
using slipfit::MotionClass;
using slipfit::ParameterStatus;

const char* name_of(MotionClass motion) {
  constexpr std::array<const char*, 4> kNames{"stick_slip", "steady_sliding", "oscillatory_slip", "undetermined"};
  return kNames.at(static_cast<std::size_t>(motion));
}

const char* name_of(ParameterStatus status) {
  constexpr std::array<const char*, 6> kNames{"identified", "weak", "bounded", "unidentified", "fixed", "conditional"};
  return kNames.at(static_cast<std::size_t>(status));
}

const slipfit::Parameter* find(const std::vector<slipfit::Parameter>& parameters, const std::string& name) {
  for (const slipfit::Parameter& parameter : parameters) {
    if (parameter.name() == name) return &parameter;
  }
  return nullptr;
}

/// Standard errors of a fit with next to no noise, scaled to the noise that was put in: the bound at the truth, with an
/// onset and an onset force of its own for each cycle.
std::map<std::string, double> bounds_of(const Scene& scene) {
  std::map<std::string, double> bounds;
  if (scene.nearly_noiseless_N.empty()) return bounds;
  const auto time_s = scene.recording.time_s();
  const auto recording = slipfit::Recording::create({time_s.begin(), time_s.end()}, scene.nearly_noiseless_N,
                                                    scene.recording.conditions());
  const Analysis analysis = slipfit::analyze_and_fit(recording.value());
  if (analysis.motion != MotionClass::StickSlip) return bounds;
  for (const slipfit::Parameter& parameter : analysis.fit->parameters) {
    if (!parameter.estimate.standard_error) continue;
    bounds[std::string(parameter.name())] =
        *parameter.estimate.standard_error * scene.noise_rms_N / analysis.fit->residual.rms;
  }
  return bounds;
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values.at(static_cast<std::size_t>(share * static_cast<double>(values.size())));
}

/// Counts over the rows of one line of the summary.
struct Tally {
  double rows = 0.0, given = 0.0, inside = 0.0, identified = 0.0, wrong = 0.0;
  std::vector<double> misses;    // in standard errors
  std::vector<double> relative;  // squared error over squared bound
  std::vector<double> errors;    // relative to the truth

  void add(const Row& row) {
    rows += 1.0;
    if (const auto covered = row.covered()) {
      given += 1.0;
      inside += *covered ? 1.0 : 0.0;
    }
    identified += row.status == "identified" ? 1.0 : 0.0;
    wrong += row.confidently_wrong() ? 1.0 : 0.0;
    if (row.estimate.value) errors.push_back(std::abs(*row.estimate.value / row.truth - 1.0));
    if (!row.estimate.value || !row.estimate.standard_error) return;
    const double error = *row.estimate.value - row.truth;
    if (*row.estimate.standard_error > 0.0) misses.push_back(error / *row.estimate.standard_error);
    if (row.bound && *row.bound > 0.0) relative.push_back(error * error / (*row.bound * *row.bound));
  }

  [[nodiscard]] std::string line(const std::string& name, const std::string& parameter) const {
    if (given == 0.0) return fmt::format("{:20s} {:8s} {:5.0f} {:5.0f}\n", name, parameter, rows, given);
    // Chance of so few truths inside if each interval held its own with 95 %.
    const double p = boost::math::cdf(boost::math::binomial_distribution<double>(given, 0.95), inside);
    double spread = 0.0;
    const double bias = mean(misses);
    for (const double z : misses) spread += (z - bias) * (z - bias) / static_cast<double>(misses.size());
    const std::string ratio = relative.empty() ? "" : fmt::format("{:.3f}", std::sqrt(mean(relative)));
    return fmt::format(
        "{:20s} {:8s} {:5.0f} {:5.0f} {:7.1f} {:8.4f}{} {:+6.2f} {:6.2f} {:>7s} {:7.1f} {:4.0f} {:9.4f} {:9.4f}\n",
        name, parameter, rows, given, 100.0 * inside / given, p, p < 0.01 ? "!" : " ", bias, std::sqrt(spread), ratio,
        100.0 * identified / rows, wrong, quantile(errors, 0.5), quantile(errors, 0.95));
  }
};

std::string motion_lines(const std::vector<Row>& rows) {
  std::map<std::string, std::pair<double, double>> right;  // of all
  for (const Row& row : rows) {
    if (row.parameter != "spacing") continue;
    auto& [good, all] = right[row.family + (row.note.empty() ? "" : " " + row.note)];
    all += 1.0;
    good += (row.motion == "stick_slip") == is_stick_slip(row.family) ? 1.0 : 0.0;
  }
  std::string text = "\nkind of motion right\n";
  for (const auto& [name, counts] : right) {
    text += fmt::format("{:20s} {:5.0f} of {:5.0f}\n", name, counts.first, counts.second);
  }
  return text;
}

std::string warning_lines(const std::vector<Row>& rows) {
  std::map<std::pair<std::string, std::string>, int> counts;
  for (const Row& row : rows) {
    std::istringstream codes(row.warnings);
    for (std::string code; codes >> code;) {
      ++counts[{row.family + (row.note.empty() ? "" : " " + row.note), code}];
    }
  }
  std::string text = "\nwarnings\n";
  for (const auto& [key, count] : counts) text += fmt::format("{:20s} {:24s} {:5d}\n", key.first, key.second, count);
  return text;
}

}  // namespace

std::optional<bool> Row::covered() const {
  if (!estimate.ci95) return std::nullopt;
  return estimate.ci95->low <= truth && truth <= estimate.ci95->high;
}

bool Row::confidently_wrong() const {
  if (status != "identified" || !estimate.value || !estimate.standard_error) return false;
  const double error = std::abs(*estimate.value - truth);
  return error > 4.0 * *estimate.standard_error && error > 0.02 * std::abs(truth);
}

std::vector<Row> fit_scene(const Scene& scene) {
  const Analysis analysis = slipfit::analyze_and_fit(scene.recording);
  const std::map<std::string, double> bounds = bounds_of(scene);
  const std::array<std::tuple<const char*, const char*, double>, 4> parameters{
      {{"k", "stiffness_N_per_m", scene.truth.stiffness_N_per_m},
       {"dF", "friction_difference_N", scene.truth.friction_difference_N},
       {"w_n", "natural_frequency_rad_per_s", scene.truth.natural_frequency_rad_per_s},
       {"zeta", "damping_ratio", scene.truth.damping_ratio}}};
  Row empty;
  empty.family = scene.family;
  empty.note = scene.note;
  empty.seed = scene.seed;
  empty.status = "unidentified";
  empty.motion = name_of(analysis.motion);
  std::vector<Row> rows;
  for (const auto& [name, key, truth] : parameters) {
    Row row = empty;
    row.parameter = name;
    row.truth = truth;
    if (const slipfit::Parameter* parameter = analysis.fit ? find(analysis.fit->parameters, key) : nullptr) {
      row.estimate = parameter->estimate;
      row.status = name_of(parameter->status);
    }
    if (const auto bound = bounds.find(key); bound != bounds.end()) row.bound = bound->second;
    rows.push_back(row);
  }
  Row spacing = empty;
  spacing.parameter = "spacing";
  spacing.truth = scene.truth.spacing_m;
  spacing.status = "measured";
  std::set<std::string> codes;
  for (const slipfit::Warning& warning : analysis.warnings) codes.insert(warning.code);
  spacing.warnings = fmt::format("{}", fmt::join(codes, " "));
  if (analysis.motion == MotionClass::StickSlip) spacing.estimate = analysis.derived.pattern_spacing_m;
  rows.push_back(spacing);
  return rows;
}

std::vector<Row> fit_joint(const Sweep& sweep) {
  constexpr std::size_t kFitted = 3;
  const std::array<std::tuple<const char*, const char*, double>, 9> parameters{
      {{"k", "stiffness_N_per_m", sweep.slider.stiffness_N_per_m()},
       {"dF", "friction_difference_N", sweep.friction.static_N() - sweep.friction.onset_N()},
       {"w_n", "natural_frequency_rad_per_s", sweep.slider.natural_frequency_rad_per_s()},
       {"zeta", "damping_ratio", sweep.slider.damping_ratio()},
       {"F_s", "static_friction_N", sweep.friction.static_N()},
       {"F_k", "kinetic_friction_N", sweep.friction.onset_N()},
       {"alpha", "alpha_s_per_m", sweep.friction.alpha_s_per_m()},
       {"f0", "f0_N", sweep.friction.f0_N()},
       {"f1", "f1_N", sweep.friction.f1_N()}}};
  const slipfit::SweepAnalysis analysis = slipfit::analyze_sweep(sweep.entries);
  std::vector<Row> rows;
  if (!analysis.fit) return rows;
  const auto add = [&](const char* name, double truth, const Estimate& estimate, const char* status) {
    Row row;
    row.family = "sweeps";
    row.note = sweep.friction.alpha_s_per_m() < 0.0 ? "alpha < 0" : "alpha > 0";
    row.seed = sweep.seed;
    row.parameter = name;
    row.truth = truth;
    row.estimate = estimate;
    row.status = status;
    if (estimate.value) rows.push_back(row);
  };
  for (const auto& [name, key, truth] : parameters) {
    if (const slipfit::Parameter* parameter = find(analysis.fit->result.parameters, key)) {
      add(name, truth, parameter->estimate, name_of(parameter->status));
    }
  }
  std::deque<slipfit::Quality> qualities;
  std::deque<slipfit::Segmentation> slips;
  std::vector<slipfit::SweepRecording> recordings;
  for (const auto& [name, recording] : sweep.entries) {
    qualities.push_back(slipfit::assess_quality(recording));
    slips.push_back(slipfit::find_slips(recording, qualities.back()));
    const auto role = recordings.size() < kFitted ? slipfit::SweepRole::Cycles : slipfit::SweepRole::LeftOut;
    recordings.push_back({recording, qualities.back(), slips.back(), role});
  }
  const auto lower = slipfit::fit_sweep(recordings, {});
  for (std::size_t i = 0; i < sweep.entries.size(); ++i) {
    const auto truth = sweep.spacing_m(sweep.entries[i].recording.conditions().speed_m_per_s);
    if (!truth) continue;
    add("left_out", *truth, analysis.fit->points[i].spacing_left_out_m, "predicted");
    if (lower && i >= kFitted) add("higher", *truth, lower->points[i].spacing_m, "predicted");
  }
  return rows;
}

std::string to_csv(const std::vector<Row>& rows) {
  const auto cell = [](const std::optional<double>& value) { return value ? fmt::format("{:.9g}", *value) : ""; };
  std::string text = "family,note,seed,parameter,truth,value,se,lo,hi,status,motion,cramer_rao,warnings\n";
  for (const Row& row : rows) {
    const Estimate& e = row.estimate;
    text += fmt::format(
        "{},{},{},{},{:.9g},{},{},{},{},{},{},{},{}\n", row.family, row.note, row.seed, row.parameter, row.truth,
        cell(e.value), cell(e.standard_error), e.ci95 ? fmt::format("{:.9g}", e.ci95->low) : "",
        e.ci95 ? fmt::format("{:.9g}", e.ci95->high) : "", row.status, row.motion, cell(row.bound), row.warnings);
  }
  return text;
}

std::string summarise(const std::vector<Row>& rows) {
  std::map<std::pair<std::string, std::string>, Tally> kinds;
  std::map<std::string, Tally> pooled;
  for (const Row& row : rows) {
    if (!is_stick_slip(row.family)) continue;
    kinds[{row.family, row.parameter}].add(row);
    if (!row.note.empty()) kinds[{row.family + " " + row.note, row.parameter}].add(row);
    if (row.family != "defect" && row.family != "ar1" && row.family != "sweeps") pooled[row.parameter].add(row);
  }
  std::string text =
      "family               param       n given  cover%   p         bias   z sd  rms/CR  ident% wrong    median     95 "
      "%\n"
      "(p: binomial chance of so few inside, ! below 1 %; bias, z sd: of (value - truth) / se; wrong: "
      "confidently; median, 95 %: of the relative errors)\n";
  for (const auto& [key, tally] : kinds) text += tally.line(key.first, key.second);
  for (const auto& [name, tally] : pooled) text += tally.line("pooled", name);
  return rows.empty() || rows.front().family == "sweeps" ? text : text + motion_lines(rows) + warning_lines(rows);
}

}  // namespace coverage
