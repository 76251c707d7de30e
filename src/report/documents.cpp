#include <filesystem>
#include <string>

#include "report/commit.hpp"
#include "report/json_sections.hpp"
#include "report/names.hpp"
#include "slipfit/report/json.hpp"
#include "slipfit/report/sweep.hpp"

namespace slipfit {
namespace {

Json timing_json(const Timing& timing) {
  return Json{{"read_s", timing.read_s},
              {"frequency_s", timing.frequency_s},
              {"fit_s", timing.fit_s},
              {"total_s", timing.total_s}};
}

/// Writes the results of one recording, alone or in a sweep.
void add_analysis(Json& json, const Recording& recording, const Analysis& analysis, std::optional<SweepRole> role) {
  json["recording"] = recording_json(recording, analysis);
  json["status"] = name_of(analysis.motion);
  json["status_reason"] = analysis.motion_reason;
  if (role) json["role"] = name_of(*role);
  json["warnings"] = analysis.warnings;
  json["frequency"] = frequency_json(analysis.frequency);
  json["cycles"] = cycles_json(analysis.cycles, recording.conditions().quantity);
}

void add_fit(Json& json, const FitResult& fit, ForceQuantity quantity) {
  json["model"] = model_json(fit, quantity);
  json["parameters"] = parameters_json(fit);
  json["correlation"] = correlation_json(fit);
}

/// Schema and program, and what was asked of it.
Json head_json(const std::string& id, const std::optional<AskedFit>& asked) {
  const std::string commit = commit_of_program();
  Json json{{"schema", "slipfit.fit/1"},
            {"$schema", "urn:slipfit:schema:slipfit.fit/1"},
            {"version", SLIPFIT_VERSION},
            {"commit", commit.empty() ? Json() : Json(commit)},
            {"id", id}};
  if (asked) json["options"] = options_json(*asked);
  return json;
}

std::string id_of(const Recording& recording, const JsonOptions& options) {
  if (!options.id.empty()) return options.id;
  return std::filesystem::path(recording.provenance().file).stem().string();
}

}  // namespace

std::string to_json(const Recording& recording, const Analysis& analysis, const JsonOptions& options) {
  Json json = head_json(id_of(recording, options), analysis.asked);
  add_analysis(json, recording, analysis, {});
  if (analysis.fit) {
    const ForceQuantity quantity = recording.conditions().quantity;
    add_fit(json, *analysis.fit, quantity);
    json["level_trend"] = level_trend_json(analysis.fit->level_trend, quantity);
    json["audit"] = audit_json(analysis.audit);
  }
  json["derived"] = derived_json(analysis.derived);
  json["transients"] = transients_json(analysis.transients, recording.conditions().quantity);
  json["coefficients"] = coefficients_json(analysis.coefficients);
  json["tests"] = tests_json(analysis.tests);
  if (options.timing) json["timing"] = timing_json(analysis.timing);
  return text_of(json, options.layout);
}

namespace {

/// One recording of the sweep: what it shows on its own, and what the fit of the sweep says of it.
Json member_json(const SweepEntry& entry, const Analysis& analysis, SweepRole role, const SweepPoint* point) {
  Json json{{"id", entry.id}};
  add_analysis(json, entry.recording, analysis, role);
  json["derived"] = derived_json(analysis.derived);
  if (point != nullptr) {
    json["joint"] = {{"cycles_used", point->cycles_used},
                     {"rms_N", point->rms},
                     {"kinetic_friction_N", point->kinetic_friction_N},
                     {"mean_steady_force_N", point->mean_steady_force_N},
                     {"spacing_m", point->spacing_m},
                     {"spacing_left_out_m", point->spacing_left_out_m},
                     {"stiffness_left_out_N_per_m", point->stiffness_left_out_N_per_m},
                     {"friction_difference_left_out_N", point->friction_difference_left_out_N}};
  }
  return json;
}

/// Writes the properties of the recordings that a prediction needs.
void add_reach(Json& json, const ModelEstimate& model) {
  if (model.ageing) json["ageing_reference_s"] = model.ageing->reference_stick_s;
  if (model.stiffness_trend) json["stiffness_speed_m_per_s"] = model.stiffness_trend->speed_m_per_s;
  if (model.normal_force_N) json["normal_force_N"] = model.normal_force_N;
  if (!model.reach) return;
  json["speeds_m_per_s"] = {model.reach->slowest_m_per_s, model.reach->fastest_m_per_s};
  json["trend_beyond"] = model.reach->trend;
}

Json repeats_json(const std::vector<Repeat>& repeats) {
  Json json = Json::object();
  for (const Repeat& repeat : repeats) {
    json[repeat.name] = repeat.mean;
    json[repeat.name]["sd"] = repeat.standard_deviation;
    json[repeat.name]["count"] = repeat.count;
  }
  return json;
}

}  // namespace

std::string to_json(std::span<const SweepEntry> entries, const SweepAnalysis& sweep, const JsonOptions& options) {
  Json json = head_json(options.id, sweep.asked);
  Json members = Json::array();
  for (std::size_t i = 0; i < entries.size(); ++i) {
    Json& member = members.emplace_back(
        member_json(entries[i], sweep.recordings[i], sweep.roles[i], sweep.fit ? &sweep.fit->points[i] : nullptr));
    if (i < sweep.audits.size() && sweep.roles[i] == SweepRole::Cycles) member["audit"] = audit_json(sweep.audits[i]);
  }
  json["recordings"] = std::move(members);
  if (!sweep.repeats.empty()) json["repeats"] = repeats_json(sweep.repeats);
  json["status"] = name_of(sweep.fit ? MotionClass::StickSlip : MotionClass::Undetermined);
  json["status_reason"] = sweep.fit_reason;
  json["warnings"] = sweep.warnings;
  if (sweep.fit) {
    add_fit(json, sweep.fit->result, ForceQuantity::Force_N);
    json["model"]["level_shared"] = sweep.fit->level_shared;
    json["model"]["static_friction_shared"] = sweep.fit->difference_shared;
    if (sweep.fit->result.estimate) add_reach(json["model"], *sweep.fit->result.estimate);
  }
  json["derived"] = derived_json(sweep.derived);
  return text_of(json, options.layout);
}

}  // namespace slipfit
