#include "rows.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <deque>
#include <map>
#include <set>
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

}  // namespace

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

}  // namespace coverage
