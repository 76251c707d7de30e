#include <string>

#include "report/json_sections.hpp"
#include "report/names.hpp"
#include "slipfit/report/sweep.hpp"

namespace slipfit {
namespace {

/// One recording of the sweep: what it shows on its own, and what the joint fit says of it.
Json member_json(const SweepEntry& entry, const Analysis& analysis, SweepRole role, const SweepPoint* point) {
  const ForceQuantity quantity = entry.recording.conditions().quantity;
  Json json{{"id", entry.id}};
  json["recording"] = recording_json(entry.recording, analysis);
  json["status"] = name_of(analysis.verdict);
  json["status_reason"] = analysis.verdict_reason;
  json["role"] = name_of(role);
  json["warnings"] = warnings_json(analysis.warnings);
  json["frequency"] = frequency_json(analysis.frequency);
  json["cycles"] = cycles_json(analysis.cycles, quantity);
  json["derived"] = derived_json(analysis.derived);
  if (point != nullptr) {
    json["joint"] = {{"cycles_used", point->cycles_used},
                     {"rms_N", number(point->rms)},
                     {"kinetic_friction_N", estimate(point->kinetic_friction_N)},
                     {"mean_steady_force_N", estimate(point->mean_steady_force_N)},
                     {"spacing_m", estimate(point->spacing_m)},
                     {"spacing_left_out_m", estimate(point->spacing_left_out_m)}};
  }
  return json;
}

}  // namespace

std::string to_json(std::span<const SweepEntry> entries, const SweepAnalysis& sweep, const JsonOptions& options) {
  Json json{{"schema", "slipfit.fit/1"}, {"version", SLIPFIT_VERSION}, {"id", options.id}};
  Json members = Json::array();
  for (std::size_t i = 0; i < entries.size(); ++i) {
    members.push_back(
        member_json(entries[i], sweep.recordings[i], sweep.roles[i], sweep.joint ? &sweep.joint->points[i] : nullptr));
  }
  json["recordings"] = std::move(members);
  json["status"] = name_of(sweep.joint ? Verdict::StickSlip : Verdict::Undetermined);
  json["status_reason"] = sweep.joint_reason;
  json["warnings"] = warnings_json(sweep.warnings);
  if (sweep.joint) {
    json["model"] = model_json(sweep.joint->fit, ForceQuantity::Force_N);
    json["model"]["level_shared"] = sweep.joint->level_shared;
    json["model"]["static_friction_shared"] = sweep.joint->difference_shared;
    if (const auto& model = sweep.joint->fit.estimate; model && model->ageing) {
      json["model"]["ageing_reference_s"] = number(model->ageing->reference_stick_s);
    }
    json["parameters"] = parameters_json(sweep.joint->fit);
    json["correlation"] = correlation_json(sweep.joint->fit);
  }
  json["derived"] = derived_json(sweep.derived);
  return text_of(json, options.layout);
}

}  // namespace slipfit
