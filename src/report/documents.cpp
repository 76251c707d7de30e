#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

#include "report/commit.hpp"
#include "report/format.hpp"
#include "report/json_values.hpp"
#include "report/quantity_rows.hpp"
#include "slipfit/core/printable.hpp"
#include "slipfit/core/range.hpp"
#include "slipfit/report/json.hpp"
#include "slipfit/report/sweep.hpp"

namespace slipfit {

void to_json(Json& json, const Interval& bounds) {
  if (is_finite(bounds.low) && is_finite(bounds.high)) json = {bounds.low, bounds.high};
}

void to_json(Json& json, const Estimate& quantity) {
  json = {{"value", quantity.value}, {"se", quantity.standard_error}, {"ci95", quantity.ci95}};
  if (!quantity.note.empty()) json["note"] = quantity.note;
}

void to_json(Json& json, const Warning& warning) {
  json = {{"code", warning.code}, {"message", warning.message}};
}

std::string text_of(const Json& json, JsonLayout layout) {
  const int indent = layout == JsonLayout::Indented ? 2 : -1;
  return printable_lines(json.dump(indent, ' ', false, Json::error_handler_t::replace));
}

Json options_json(const AskedFit& asked) {
  Json fix = Json::object();
  const auto put = [&](ParameterId id, const std::optional<double>& value) {
    if (value) fix[std::string(info(id).key)] = *value;
  };
  put(ParameterId::Stiffness, asked.held.stiffness_N_per_m);
  put(ParameterId::NaturalFrequency, asked.held.natural_frequency_rad_per_s);
  put(ParameterId::DampingRatio, asked.held.damping_ratio);
  return Json{{"tier", asked.tier ? Json(*asked.tier) : Json("auto")}, {"fix", fix}};
}

namespace {

/// Returns the object, whose numbers NAME_N have the unit of the force column. For a friction coefficient these keys
/// are null, and the numbers are in the object "coefficient" instead.
Json in_force_unit(Json object, ForceQuantity quantity) {
  if (quantity == ForceQuantity::Force_N) return object;
  Json coefficient = Json::object();
  for (const auto& [key, value] : object.items()) {
    if (key.ends_with("_N")) coefficient[key.substr(0, key.size() - 2)] = std::exchange(value, nullptr);
  }
  object["coefficient"] = std::move(coefficient);
  return object;
}

template <class Table, class Owner>
void put_all(Json& json, const Table& table, const Owner& owner) {
  for (const auto& quantity : table) json[std::string(quantity.key)] = quantity.of(owner);
}

Json quality_json(const Recording& recording, const Quality& quality) {
  const Provenance& provenance = recording.provenance();
  return in_force_unit({{"noise_rms_N", quality.noise_rms},
                        {"quantisation_step_N", quality.quantisation_step},
                        {"clip_high_N", quality.clip_high},
                        {"clip_low_N", quality.clip_low},
                        {"clipped_samples", quality.clipped_samples},
                        {"impulses", quality.impulses},
                        {"gaps", quality.gaps},
                        {"longest_gap_s", quality.longest_gap_s},
                        {"clock_jitter", quality.clock_jitter},
                        {"rows_without_number", provenance.rows_without_number},
                        {"rows_backward_in_time", provenance.rows_backward_in_time},
                        {"rows_repeating_time", provenance.rows_repeating_time}},
                       recording.conditions().quantity);
}

Json recording_json(const Recording& recording, const Analysis& analysis) {
  const Conditions& conditions = recording.conditions();
  const Provenance& provenance = recording.provenance();
  Json stated = Json::object();
  for (const auto& [column, cell] : provenance.options) stated[column] = cell;
  Json json{{"file", provenance.file},
            {"input_digest", provenance.input_digest ? Json(provenance.input_digest->text()) : Json()},
            {"input_bytes", provenance.input_bytes},
            {"samples", recording.size()},
            {"sample_rate_Hz", 1.0 / recording.sample_interval_s()},
            {"duration_s", recording.duration_s()},
            {"speed_m_per_s", conditions.speed_is_known ? Json(conditions.speed_m_per_s) : Json()},
            {"speed_unit", text_or_null(conditions.speed_unit)},
            {"speed_se_m_per_s", conditions.speed_standard_error_m_per_s},
            {"normal_force_N", conditions.normal_force_N},
            {"force_view", conditions.force_view},
            {"force_quantity", conditions.quantity},
            {"zero_force_N", conditions.zero_force_N},
            {"mass_kg", conditions.mass_kg},
            {"mass_se_kg", conditions.mass_standard_error_kg},
            {"sensor_bandwidth_Hz", conditions.sensor_bandwidth_Hz},
            {"drive_period_s", conditions.drive_period_s},
            {"drift", conditions.drift == LevelReading::Open ? Json() : Json(conditions.drift)},
            {"sensor_average_s", conditions.sensor_average_s},
            {"sensor_resonance_Hz", conditions.sensor_resonance_Hz},
            {"options", std::move(stated)},
            {"assumed", provenance.assumed},
            {"sliding_s", {analysis.sliding.begin_s, analysis.sliding.end_s}},
            {"quality", quality_json(recording, analysis.quality)}};
  if (conditions.sensor_filter_order > 1) json["sensor_filter_order"] = conditions.sensor_filter_order;
  if (conditions.drive_path_m) json["drive_path_m"] = *conditions.drive_path_m;
  const Labels& labels = conditions.labels;
  for (const auto& [key, label] : {std::pair{"group", &labels.group},
                                   {"sample", &labels.sample},
                                   {"material", &labels.material},
                                   {"operator", &labels.operator_name}}) {
    if (!label->empty()) json[key] = *label;
  }
  if (conditions.worn_track && !conditions.worn_track->inputs.empty()) {
    json["other_inputs"] = array_of(conditions.worn_track->inputs, [](const InputFile& input) {
      return Json{{"file", input.file}, {"input_digest", input.digest.text()}, {"input_bytes", input.bytes}};
    });
  }
  return json;
}

Json frequency_json(const FrequencyReport& frequency) {
  const auto in_Hz = [](const Estimate& estimate) {
    return Json{{"value_Hz", estimate.value}, {"se_Hz", estimate.standard_error}, {"ci95_Hz", estimate.ci95}};
  };
  const SpectralFrequency& spectral = frequency.spectral;
  Json json = in_Hz(frequency.quoted);
  json["method"] = frequency.method;
  json["false_alarm_probability"] = spectral.false_alarm_probability;
  json["harmonics"] = spectral.harmonics_Hz;
  json["suspicious_lines"] = array_of(spectral.suspicious_lines, [](const SuspiciousLine& line) {
    return Json{{"frequency_Hz", line.frequency_Hz}, {"reason", line.reason}};
  });
  json["lines"] = array_of(frequency.lines, [](const SuspiciousLine& line) {
    return Json{{"frequency_Hz", line.frequency_Hz}, {"swing", line.swing}, {"reason", line.reason}};
  });
  json["spectral"] = {{"value_Hz", spectral.value_Hz}, {"se_Hz", spectral.standard_error_Hz}};
  json["counted"] = in_Hz(frequency.counted);
  if (!frequency.quoted.note.empty()) json["note"] = frequency.quoted.note;
  return json;
}

Json cycles_json(const CycleStatistics& cycles, ForceQuantity quantity) {
  return in_force_unit(
      {{"count", cycles.count},
       {"minor", cycles.minor},
       {"used", cycles.used},
       {"period_s", cycles.period_s},
       {"period_sd_s", cycles.period_sd_s},
       {"slip_time_s", cycles.slip_time_s},
       {"stick_time_s", cycles.stick_time_s},
       {"sticking_degree", cycles.sticking_degree},
       {"drop_cv", cycles.drop_cv},
       {"period_cv", cycles.period_cv},
       {"regularity", cycles.regularity},
       {"stick_stiffness_N_per_m", quantity == ForceQuantity::Force_N ? Json(cycles.stick_stiffness) : Json()},
       {"peak_force_N", cycles.peak_force},
       {"peak_force_sd_N", cycles.peak_force_sd},
       {"trough_force_N", cycles.trough_force},
       {"force_drop_N", cycles.force_drop},
       {"force_drop_sd_N", cycles.force_drop_sd}},
      quantity);
}

using Id = ParameterId;

struct TermRow {
  std::string_view code;
  std::array<Id, 2> parameters;  ///< twice the same: one; the first is the one of the text
  std::string_view words;
};

constexpr auto kTerms = std::to_array<TermRow>({
    {"samples_averaged", {Id::SensorAverage, Id::SensorAverage}, "sensor averaging over"},
    {"slip_weakening", {Id::SlipDistance, Id::SlipDistance}, "friction that weakens over a slip distance of"},
    {"force_recovery", {Id::ReloadForce, Id::ReloadLength}, "force recovery after a slip of"},
    {"relaxing_spring", {Id::Relaxation, Id::RelaxationTime}, "a spring that relaxes by a share of"},
    {"stiffness_changes",
     {Id::StiffnessRatio, Id::StiffnessRatio},
     "a change of k along the path (k is that in its middle) by a factor of"},
    {"stiffness_goes_with_speed", {Id::StiffnessExponent, Id::StiffnessExponent}, "k proportional to V to the power"},
    {"static_friction_ages", {Id::Ageing, Id::AgeingTime}, "static friction that ages at a rate of"},
});

/// Returns the effects in the model of a fit besides stick-slip itself, with what is known of them.
Json terms_json(const FitResult& fit) {
  Json terms = Json::array();
  for (const TermRow& row : kTerms) {
    const Parameter* const first = fit.find(row.parameters.front());
    if (first == nullptr || !first->estimate.value) continue;
    Json keys = Json::array();
    for (const Id id : row.parameters) {
      const Json key = info(id).key;
      if (fit.find(id) != nullptr && (keys.empty() || keys.back() != key)) keys.push_back(key);
    }
    const EstimateRow shown = estimate_row(first->estimate, std::string(info(first->id).unit));
    const std::string interval = shown.interval.empty() ? "" : " " + shown.interval;
    terms.push_back({{"code", row.code},
                     {"parameters", std::move(keys)},
                     {"text", fmt::format("{} {}{}", row.words, value_text(shown), interval)}});
  }
  for (const Warning& warning : fit.warnings) {
    if (warning.code != "hum_fitted") continue;
    terms.push_back({{"code", warning.code}, {"parameters", Json::array()}, {"text", warning.message}});
  }
  return terms;
}

Json model_json(const FitResult& fit, ForceQuantity quantity) {
  const auto candidate_json = [quantity](const Candidate& candidate) {
    return in_force_unit({{"tier", candidate.tier},
                          {"parameters", candidate.parameters},
                          {"rms_N", candidate.rms},
                          {"aicc", candidate.aicc},
                          {"chosen", candidate.chosen},
                          {"reason", candidate.reason}},
                         quantity);
  };
  return Json{{"tier", fit.tier},
              {"conditional_on", fit.conditional_on},
              {"candidates", array_of(fit.candidates, candidate_json)},
              {"residual", in_force_unit({{"rms_N", fit.residual.rms},
                                          {"reduced_chi2", fit.residual.reduced_chi2},
                                          {"whiteness_p", fit.residual.whiteness_p}},
                                         quantity)},
              {"degrees_of_freedom", fit.estimate ? Json(fit.estimate->degrees_of_freedom) : Json()},
              {"terms", terms_json(fit)}};
}

Json parameters_json(const FitResult& fit) {
  Json json = Json::object();
  for (const Parameter& parameter : fit.parameters) {
    const bool is_interval = parameter.status == ParameterStatus::Bounded;  // its middle is no estimate
    json[std::string(parameter.name())] = {{"value", is_interval ? Json() : Json(parameter.estimate.value)},
                                           {"se", parameter.estimate.standard_error},
                                           {"ci95", parameter.estimate.ci95},
                                           {"status", parameter.status},
                                           {"note", parameter.estimate.note}};
  }
  return json;
}

/// Writes the matrix, the values to which the covariance belongs, and the standard errors that with the matrix are the
/// whole covariance. A value that the data hardly determine alone, and whose parameter is therefore null, is still
/// included: together with the others it predicts. If zeta is at 0, the se of the parameters is wider.
Json correlation_json(const FitResult& fit) {
  if (!fit.correlation) return nullptr;
  const auto& [names, matrix] = *fit.correlation;
  Json json{{"names", names}, {"matrix", matrix}};
  if (!fit.estimate) return json;
  json["values"] =
      array_of(names, [&](const std::string& name) { return *fit.estimate->find(parameter_with_key(name).value()); });
  json["scaled_se"] = array_of(names, [&](const std::string& name) {
    const std::size_t i = place_in_model(parameter_with_key(name).value());
    return std::sqrt(std::max(0.0, fit.estimate->covariance[i][i]));
  });
  return json;
}

Json level_trend_json(const LevelTrend& trend, ForceQuantity quantity) {
  const bool newtons = quantity == ForceQuantity::Force_N;
  Json json{{"value_N_per_s", newtons ? Json(trend.rate_per_s.value) : Json()}};
  if (!newtons) json["value_per_s"] = trend.rate_per_s.value;
  json["se"] = trend.rate_per_s.standard_error;
  json["ci95"] = trend.rate_per_s.ci95;
  json["reading"] = trend.level_range ? Json(trend.reading) : Json("none");
  return json;
}

Json audit_json(const std::vector<AuditPair>& pairs) {
  const auto value_of = [](const std::string& of, const Estimate& estimate) {
    return Json{{"of", of}, {"value", estimate.value}, {"se", estimate.standard_error}};
  };
  return array_of(pairs, [&](const AuditPair& pair) {
    return Json{{"pair", pair.pair},
                {"values", {value_of(pair.first_of, pair.first), value_of(pair.second_of, pair.second)}},
                {"contradicts", pair.contradicts}};
  });
}

Json tests_json(const std::vector<ShortTest>& tests) {
  return array_of(tests, [](const ShortTest& test) {
    return Json{{"name", test.kind},
                {"value", test.value},
                {"se", test.standard_error},
                {"p_value", test.p_value},
                {"finding", test.finding}};
  });
}

Json derived_json(const Derived& derived) {
  Json json{{"regime", nullptr}, {"bistable", nullptr}};
  if (derived.regime) {
    json = {{"regime", *derived.regime}, {"bistable", *derived.regime == Regime::StickSlipBistable}};
  }
  put_all(json, kPredicted, derived);
  put_all(json, kMeasured, derived);
  if (derived.observed_end) {
    json["observed_end_m_per_s"] = {derived.observed_end->sticks_m_per_s, derived.observed_end->slides_m_per_s};
  }
  if (derived.surface_spacing_m) {
    put_all(json, kOnSurface, derived);
    json["surface_verdict"] = derived.surface_verdict;
  }
  if (derived.measured_spacing_En) json["measured_spacing_En"] = *derived.measured_spacing_En;
  return json;
}

/// Null without a load.
Json coefficients_json(const std::optional<Coefficients>& coefficients) {
  if (!coefficients) return {};
  Json json = Json::object();
  put_all(json, kCoefficients, *coefficients);
  put_all(json, kCoefficientThirds, *coefficients);
  for (const auto& row : kCoefficientSpreads) json[std::string(row.key)] = row.of(*coefficients).value;
  json["standards"] = array_of(coefficients->standards, [](const StandardCoefficients& standard) {
    return Json{{"standard", standard.standard},
                {"prescribes", standard.prescribes},
                {"static_coefficient", standard.static_coefficient},
                {"kinetic_coefficient", standard.kinetic_coefficient},
                {"differs", standard.differs}};
  });
  return json;
}

Json transients_json(const Transients& transients, ForceQuantity quantity) {
  const bool newtons = quantity == ForceQuantity::Force_N;
  Json json = Json::object();
  for (const auto& row : kTransients) {
    json[std::string(row.key)] = newtons || !row.unit.starts_with('N') ? Json(row.of(transients)) : Json();
  }
  if (!newtons) json["breakaway_coefficient"] = transients.breakaway_force;
  return json;
}

Json timing_json(const Timing& timing) {
  return Json{{"read_s", timing.read_s},
              {"frequency_s", timing.frequency_s},
              {"fit_s", timing.fit_s},
              {"total_s", timing.total_s}};
}

/// Writes the results of one recording, alone or in a sweep.
void add_analysis(Json& json, const Recording& recording, const Analysis& analysis, std::optional<SweepRole> role) {
  json["recording"] = recording_json(recording, analysis);
  json["status"] = analysis.motion;
  json["status_reason"] = analysis.motion_reason;
  if (role) json["role"] = *role;
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
  Json json{{"schema", "slipfit.fit/1"},
            {"$schema", "urn:slipfit:schema:slipfit.fit/1"},
            {"version", SLIPFIT_VERSION},
            {"commit", text_or_null(commit_of_program())},
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
  json["status"] = sweep.fit ? MotionClass::StickSlip : MotionClass::Undetermined;
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
