#include "report/json_sections.hpp"
#include "report/names.hpp"

namespace slipfit {
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
  json["longest_gap_s"] = number(quality.longest_gap_s);
  json["clock_jitter"] = number(quality.clock_jitter);
  json["rows_without_number"] = provenance.rows_without_number;
  json["rows_backward_in_time"] = provenance.rows_backward_in_time;
  json["rows_repeating_time"] = provenance.rows_repeating_time;
  forces.finish();
  return json;
}

}  // namespace

Json recording_json(const Recording& recording, const Analysis& analysis) {
  const Conditions& conditions = recording.conditions();
  const Provenance& provenance = recording.provenance();
  return Json{{"file", provenance.file},
              {"input_digest", provenance.input_digest ? Json(provenance.input_digest->text()) : Json()},
              {"input_bytes", provenance.input_bytes ? Json(*provenance.input_bytes) : Json()},
              {"samples", recording.size()},
              {"sample_rate_Hz", number(1.0 / recording.sample_interval_s())},
              {"duration_s", number(recording.duration_s())},
              {"speed_m_per_s", number(conditions.speed_m_per_s)},
              {"speed_se_m_per_s", number(conditions.speed_standard_error_m_per_s)},
              {"normal_force_N", number(conditions.normal_force_N)},
              {"force_view", name_of(conditions.force_view)},
              {"force_quantity", name_of(conditions.quantity)},
              {"zero_force_N", number(conditions.zero_force_N)},
              {"mass_kg", number(conditions.mass_kg)},
              {"sensor_bandwidth_Hz", number(conditions.sensor_bandwidth_Hz)},
              {"drive_period_s", number(conditions.drive_period_s)},
              {"sensor_resonance_Hz", number(conditions.sensor_resonance_Hz)},
              {"assumed", provenance.assumed},
              {"sliding_s", {number(analysis.sliding.begin_s), number(analysis.sliding.end_s)}},
              {"quality", quality_json(recording, analysis.quality)}};
}

Json warnings_json(const Warnings& warnings) {
  Json json = Json::array();
  for (const Warning& warning : warnings) json.push_back({{"code", warning.code}, {"message", warning.message}});
  return json;
}

Json frequency_json(const FrequencyReport& frequency) {
  Json harmonics = Json::array();
  for (const double harmonic_Hz : frequency.spectral.harmonics_Hz) harmonics.push_back(number(harmonic_Hz));
  Json lines = Json::array();
  for (const SuspiciousLine& line : frequency.spectral.suspicious_lines) {
    lines.push_back({{"frequency_Hz", number(line.frequency_Hz)}, {"reason", line.reason}});
  }
  Json beside = Json::array();
  for (const SuspiciousLine& line : frequency.lines) {
    beside.push_back(
        {{"frequency_Hz", number(line.frequency_Hz)}, {"swing", number(line.swing)}, {"reason", line.reason}});
  }
  Json json{
      {"value_Hz", number(frequency.quoted.value)},
      {"se_Hz", number(frequency.quoted.standard_error)},
      {"ci95_Hz", interval(frequency.quoted.ci95)},
      {"method", frequency.method.empty() ? "none" : frequency.method},
      {"false_alarm_probability", number(frequency.spectral.false_alarm_probability)},
      {"harmonics", std::move(harmonics)},
      {"suspicious_lines", std::move(lines)},
      {"lines", std::move(beside)},
      {"spectral",
       {{"value_Hz", number(frequency.spectral.value_Hz)}, {"se_Hz", number(frequency.spectral.standard_error_Hz)}}},
      {"counted",
       {{"value_Hz", number(frequency.counted.value)},
        {"se_Hz", number(frequency.counted.standard_error)},
        {"ci95_Hz", interval(frequency.counted.ci95)}}}};
  if (!frequency.quoted.note.empty()) json["note"] = frequency.quoted.note;
  return json;
}

Json cycles_json(const CycleStatistics& cycles, ForceQuantity quantity) {
  Json json{{"count", cycles.count},
            {"minor", cycles.minor},
            {"used", cycles.used},
            {"period_s", number(cycles.period_s)},
            {"period_sd_s", number(cycles.period_sd_s)},
            {"slip_time_s", number(cycles.slip_time_s)},
            {"stick_time_s", number(cycles.stick_time_s)},
            {"sticking_degree", number(cycles.sticking_degree)},
            {"drop_cv", number(cycles.drop_cv)},
            {"period_cv", number(cycles.period_cv)},
            {"regularity", cycles.regularity ? Json(name_of(*cycles.regularity)) : Json()}};
  ForceKeys forces(json, quantity);
  forces.put("peak_force", cycles.peak_force);
  forces.put("peak_force_sd", cycles.peak_force_sd);
  forces.put("trough_force", cycles.trough_force);
  forces.put("force_drop", cycles.force_drop);
  forces.put("force_drop_sd", cycles.force_drop_sd);
  forces.finish();
  return json;
}

}  // namespace slipfit
