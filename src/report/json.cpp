#include "slipfit/report/json.hpp"

#include <filesystem>

#include "report/json_sections.hpp"
#include "report/names.hpp"

namespace slipfit {
namespace {

Json timing_json(const Timing& timing) {
  return Json{{"read_s", number(timing.read_s)},
              {"frequency_s", number(timing.frequency_s)},
              {"fit_s", number(timing.fit_s)},
              {"total_s", number(timing.total_s)}};
}

std::string id_of(const Recording& recording, const JsonOptions& options) {
  if (!options.id.empty()) return options.id;
  return std::filesystem::path(recording.provenance().file).stem().string();
}

}  // namespace

std::string to_json(const Recording& recording, const Analysis& analysis, const JsonOptions& options) {
  const ForceQuantity quantity = recording.conditions().quantity;
  Json json{{"schema", "slipfit.fit/1"}, {"version", SLIPFIT_VERSION}, {"id", id_of(recording, options)}};
  json["recording"] = recording_json(recording, analysis);
  json["status"] = name_of(analysis.verdict);
  json["status_reason"] = analysis.verdict_reason;
  json["warnings"] = warnings_json(analysis.warnings);
  json["frequency"] = frequency_json(analysis.frequency);
  json["cycles"] = cycles_json(analysis.cycles, quantity);
  if (analysis.fit) {
    json["model"] = model_json(*analysis.fit, quantity);
    json["parameters"] = parameters_json(*analysis.fit);
    json["correlation"] = correlation_json(*analysis.fit);
  }
  json["derived"] = derived_json(analysis.derived);
  json["transients"] = transients_json(analysis.transients, quantity);
  json["tests"] = tests_json(analysis.tests);
  if (options.timing) json["timing"] = timing_json(analysis.timing);
  return text_of(json, options.layout);
}

}  // namespace slipfit
