#include "report/json_sections.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "report/format.hpp"
#include "report/names.hpp"
#include "report/quantity_rows.hpp"
#include "slipfit/core/printable.hpp"
#include "slipfit/core/range.hpp"

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

void ForceKeys::put(const std::string& name, std::optional<double> value) {
  if (quantity_ == ForceQuantity::Force_N) {
    object_[name + "_N"] = value;
  } else {
    object_[name + "_N"] = nullptr;
    coefficient_[name] = value;
  }
}

void ForceKeys::finish() {
  if (quantity_ == ForceQuantity::FrictionCoefficient) object_["coefficient"] = std::move(coefficient_);
}

namespace {

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
    {"stiffness_goes_with_speed", {Id::StiffnessExponent, Id::StiffnessExponent}, "k proportional to V to the power"},
    {"static_friction_ages", {Id::Ageing, Id::AgeingTime}, "static friction that ages at a rate of"},
});

}  // namespace

std::vector<ModelTerm> model_terms(const FitResult& fit) {
  std::vector<ModelTerm> terms;
  for (const TermRow& row : kTerms) {
    const Parameter* const first = fit.find(row.parameters.front());
    if (first == nullptr || !first->estimate.value) continue;
    const EstimateRow shown = estimate_row(first->estimate, std::string(info(first->id).unit));
    ModelTerm term{row.code, {}, {}};
    for (const Id id : row.parameters) {
      if (fit.find(id) != nullptr && std::ranges::find(term.parameters, id) == term.parameters.end()) {
        term.parameters.push_back(id);
      }
    }
    term.text =
        fmt::format("{} {}{}", row.words, value_text(shown), shown.interval.empty() ? "" : " " + shown.interval);
    terms.push_back(std::move(term));
  }
  for (const Warning& warning : fit.warnings) {
    if (warning.code == "hum_fitted") terms.push_back({"hum_fitted", {}, warning.message});
  }
  return terms;
}

namespace {

Json quality_json(const Recording& recording, const Quality& quality) {
  const Provenance& provenance = recording.provenance();
  Json json = Json::object();
  ForceKeys forces(json, recording.conditions().quantity);
  forces.put("noise_rms", quality.noise_rms);
  forces.put("quantisation_step", quality.quantisation_step);
  forces.put("clip_high", quality.clip_high);
  forces.put("clip_low", quality.clip_low);
  json["clipped_samples"] = quality.clipped_samples;
  json["impulses"] = quality.impulses;
  json["gaps"] = quality.gaps;
  json["longest_gap_s"] = quality.longest_gap_s;
  json["clock_jitter"] = quality.clock_jitter;
  json["rows_without_number"] = provenance.rows_without_number;
  json["rows_backward_in_time"] = provenance.rows_backward_in_time;
  json["rows_repeating_time"] = provenance.rows_repeating_time;
  forces.finish();
  return json;
}

/// Files that were read in addition to the recording, if any.
void put_other_inputs(Json& json, const Conditions& conditions) {
  if (!conditions.worn_track || conditions.worn_track->inputs.empty()) return;
  json["other_inputs"] = array_of(conditions.worn_track->inputs, [](const InputFile& input) {
    return Json{{"file", input.file}, {"input_digest", input.digest.text()}, {"input_bytes", input.bytes}};
  });
}

Json cells_json(const std::vector<std::pair<std::string, std::string>>& cells) {
  Json json = Json::object();
  for (const auto& [column, cell] : cells) json[column] = cell;
  return json;
}

}  // namespace

Json options_json(const AskedFit& asked) {
  Json fix = Json::object();
  const auto put = [&](ParameterId id, const std::optional<double>& value) {
    if (value) fix[std::string(info(id).key)] = *value;
  };
  put(ParameterId::Stiffness, asked.held.stiffness_N_per_m);
  put(ParameterId::NaturalFrequency, asked.held.natural_frequency_rad_per_s);
  put(ParameterId::DampingRatio, asked.held.damping_ratio);
  return Json{{"tier", asked.tier ? std::string(name_of(*asked.tier)) : "auto"}, {"fix", fix}};
}

Json recording_json(const Recording& recording, const Analysis& analysis) {
  const Conditions& conditions = recording.conditions();
  const Provenance& provenance = recording.provenance();
  Json json{{"file", provenance.file},
            {"input_digest", provenance.input_digest ? Json(provenance.input_digest->text()) : Json()},
            {"input_bytes", provenance.input_bytes},
            {"samples", recording.size()},
            {"sample_rate_Hz", 1.0 / recording.sample_interval_s()},
            {"duration_s", recording.duration_s()},
            {"speed_m_per_s", conditions.speed_is_known ? Json(conditions.speed_m_per_s) : Json()},
            {"speed_unit", conditions.speed_unit.empty() ? Json() : Json(conditions.speed_unit)},
            {"speed_se_m_per_s", conditions.speed_standard_error_m_per_s},
            {"normal_force_N", conditions.normal_force_N},
            {"force_view", name_of(conditions.force_view)},
            {"force_quantity", name_of(conditions.quantity)},
            {"zero_force_N", conditions.zero_force_N},
            {"mass_kg", conditions.mass_kg},
            {"mass_se_kg", conditions.mass_standard_error_kg},
            {"sensor_bandwidth_Hz", conditions.sensor_bandwidth_Hz},
            {"drive_period_s", conditions.drive_period_s},
            {"drift", conditions.drift == LevelReading::Open ? Json() : Json(name_of(conditions.drift))},
            {"sensor_average_s", conditions.sensor_average_s},
            {"sensor_resonance_Hz", conditions.sensor_resonance_Hz},
            {"options", cells_json(provenance.options)},
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
  put_other_inputs(json, conditions);
  return json;
}

Json frequency_json(const FrequencyReport& frequency) {
  Json json{
      {"value_Hz", frequency.quoted.value},
      {"se_Hz", frequency.quoted.standard_error},
      {"ci95_Hz", frequency.quoted.ci95},
      {"method", name_of(frequency.method)},
      {"false_alarm_probability", frequency.spectral.false_alarm_probability},
      {"harmonics", frequency.spectral.harmonics_Hz},
      {"suspicious_lines", array_of(frequency.spectral.suspicious_lines,
                                    [](const SuspiciousLine& line) {
                                      return Json{{"frequency_Hz", line.frequency_Hz}, {"reason", line.reason}};
                                    })},
      {"lines",
       array_of(frequency.lines,
                [](const SuspiciousLine& line) {
                  return Json{{"frequency_Hz", line.frequency_Hz}, {"swing", line.swing}, {"reason", line.reason}};
                })},
      {"spectral", {{"value_Hz", frequency.spectral.value_Hz}, {"se_Hz", frequency.spectral.standard_error_Hz}}},
      {"counted",
       {{"value_Hz", frequency.counted.value},
        {"se_Hz", frequency.counted.standard_error},
        {"ci95_Hz", frequency.counted.ci95}}}};
  if (!frequency.quoted.note.empty()) json["note"] = frequency.quoted.note;
  return json;
}

Json cycles_json(const CycleStatistics& cycles, ForceQuantity quantity) {
  Json json{{"count", cycles.count},
            {"minor", cycles.minor},
            {"used", cycles.used},
            {"period_s", cycles.period_s},
            {"period_sd_s", cycles.period_sd_s},
            {"slip_time_s", cycles.slip_time_s},
            {"stick_time_s", cycles.stick_time_s},
            {"sticking_degree", cycles.sticking_degree},
            {"drop_cv", cycles.drop_cv},
            {"period_cv", cycles.period_cv},
            {"regularity", cycles.regularity ? Json(name_of(*cycles.regularity)) : Json()},
            {"stick_stiffness_N_per_m", quantity == ForceQuantity::Force_N ? Json(cycles.stick_stiffness) : Json()}};
  ForceKeys forces(json, quantity);
  forces.put("peak_force", cycles.peak_force);
  forces.put("peak_force_sd", cycles.peak_force_sd);
  forces.put("trough_force", cycles.trough_force);
  forces.put("force_drop", cycles.force_drop);
  forces.put("force_drop_sd", cycles.force_drop_sd);
  forces.finish();
  return json;
}

namespace {

Json candidate_json(const Candidate& candidate, ForceQuantity quantity) {
  Json json{{"tier", name_of(candidate.tier)}, {"parameters", candidate.parameters}};
  ForceKeys forces(json, quantity);
  forces.put("rms", candidate.rms);
  json["aicc"] = candidate.aicc;
  json["chosen"] = candidate.chosen;
  json["reason"] = candidate.reason;
  forces.finish();
  return json;
}

/// Writes the values to which the covariance belongs, in the order of Correlation::names. A value that the data hardly
/// determine alone, and whose parameter is therefore null, is still included: together with the others it predicts.
Json working_values_json(const Correlation& correlation, const ModelEstimate& estimate) {
  return array_of(correlation.names,
                  [&estimate](const std::string& name) { return *estimate.find(parameter_with_key(name).value()); });
}

/// Writes the standard errors that with the matrix are the whole covariance. If zeta is at 0, the se of the parameters
/// is wider.
Json scaled_errors_json(const Correlation& correlation, const ModelEstimate& estimate) {
  return array_of(correlation.names, [&estimate](const std::string& name) {
    const std::size_t i = place_in_model(parameter_with_key(name).value());
    return std::sqrt(std::max(0.0, estimate.covariance[i][i]));
  });
}

}  // namespace

Json model_json(const FitResult& fit, ForceQuantity quantity) {
  Json residual = Json::object();
  ForceKeys forces(residual, quantity);
  forces.put("rms", fit.residual.rms);
  residual["reduced_chi2"] = fit.residual.reduced_chi2;
  residual["whiteness_p"] = fit.residual.whiteness_p;
  forces.finish();
  return Json{
      {"tier", name_of(fit.tier)},
      {"conditional_on", fit.conditional_on},
      {"candidates", array_of(fit.candidates, [quantity](const Candidate& c) { return candidate_json(c, quantity); })},
      {"residual", std::move(residual)},
      {"degrees_of_freedom", fit.estimate ? Json(fit.estimate->degrees_of_freedom) : Json()},
      {"terms", array_of(model_terms(fit), [](const ModelTerm& term) {
         const auto key_of = [](ParameterId id) { return Json(info(id).key); };
         return Json{{"code", term.code}, {"parameters", array_of(term.parameters, key_of)}, {"text", term.text}};
       })}};
}

Json parameters_json(const FitResult& fit) {
  Json json = Json::object();
  for (const Parameter& parameter : fit.parameters) {
    const bool is_interval = parameter.status == ParameterStatus::Bounded;  // its middle is no estimate
    json[std::string(parameter.name())] = {{"value", is_interval ? Json() : Json(parameter.estimate.value)},
                                           {"se", parameter.estimate.standard_error},
                                           {"ci95", parameter.estimate.ci95},
                                           {"status", name_of(parameter.status)},
                                           {"note", parameter.estimate.note}};
  }
  return json;
}

Json correlation_json(const FitResult& fit) {
  if (!fit.correlation) return nullptr;
  Json json{{"names", fit.correlation->names}, {"matrix", fit.correlation->matrix}};
  if (fit.estimate) {
    json["values"] = working_values_json(*fit.correlation, *fit.estimate);
    json["scaled_se"] = scaled_errors_json(*fit.correlation, *fit.estimate);
  }
  return json;
}

Json level_trend_json(const LevelTrend& trend, ForceQuantity quantity) {
  const bool newtons = quantity == ForceQuantity::Force_N;
  Json json{{"value_N_per_s", newtons ? Json(trend.rate_per_s.value) : Json()}};
  if (!newtons) json["value_per_s"] = trend.rate_per_s.value;
  json["se"] = trend.rate_per_s.standard_error;
  json["ci95"] = trend.rate_per_s.ci95;
  json["reading"] = trend.level_range ? name_of(trend.reading) : "none";
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
    return Json{{"name", name_of(test.kind)},
                {"value", test.value},
                {"se", test.standard_error},
                {"p_value", test.p_value},
                {"finding", test.finding}};
  });
}

namespace {

template <class Table, class Owner>
void put_all(Json& json, const Table& table, const Owner& owner) {
  for (const auto& quantity : table) json[std::string(quantity.key)] = quantity.of(owner);
}

}  // namespace

Json derived_json(const Derived& derived) {
  Json json{{"regime", nullptr}, {"bistable", nullptr}};
  if (derived.regime) {
    json = {{"regime", name_of(*derived.regime)}, {"bistable", *derived.regime == Regime::StickSlipBistable}};
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

}  // namespace slipfit
