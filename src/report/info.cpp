#include "slipfit/report/info.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "report/json_values.hpp"

namespace slipfit {
namespace {

template <class Value>
Json known_or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json();
}

Json text_or_null(const std::string& text) {
  return text.empty() ? Json() : Json(text);
}

Json json_of(const StepInfo& step) {
  return {{"step", step.step},
          {"rows", {step.rows.first, step.rows.last}},
          {"time_s", step.time_s ? Json{step.time_s->begin_s, step.time_s->end_s} : Json()},
          {"speed_m_per_s", known_or_null(step.speed_m_per_s)},
          {"normal_force_N", known_or_null(step.normal_force_N)}};
}

std::string info_steps_text(const std::vector<StepInfo>& steps) {
  constexpr std::size_t kMostShown = 50;
  std::string text = fmt::format("\nSteps\n");
  for (std::size_t i = 0; i < std::min(steps.size(), kMostShown); ++i) {
    const StepInfo& step = steps[i];
    text += fmt::format("  {:<4} rows {} to {}", step.step, step.rows.first, step.rows.last);
    if (step.time_s) text += fmt::format(", {:.6g} to {:.6g} s", step.time_s->begin_s, step.time_s->end_s);
    if (step.speed_m_per_s) text += fmt::format(", {:.6g} m/s", *step.speed_m_per_s);
    if (step.normal_force_N) text += fmt::format(", normal force {:.6g} N", *step.normal_force_N);
    text += "\n";
  }
  if (steps.size() > kMostShown) text += fmt::format("  ... and {} more\n", steps.size() - kMostShown);
  return text;
}

std::string info_taken_text(const Inspection& inspection) {
  const FileInfo& info = inspection.info;
  std::string text = "\nTaken\n";
  const auto add = [&text](const char* name, const std::string& value) {
    text += fmt::format("  {:<13} {}\n", name, value);
  };
  add("time", info.taken.time_column.value_or("-"));
  add("force", info.taken.force_column.value_or("-"));
  add("normal force", info.taken.normal_force_column.value_or("- (--normal-force)"));
  add("speed", info.taken.speed_m_per_s ? fmt::format("{:.6g} m/s", *info.taken.speed_m_per_s) : "- (--speed)");
  if (info.sample_rate_Hz) add("sampling rate", fmt::format("{:.6g} Hz", *info.sample_rate_Hz));
  if (info.strokes > 1) add("strokes", std::to_string(info.strokes));
  if (const auto& span = inspection.sliding) {
    add("slides", fmt::format("{:.6g} to {:.6g} s", span->begin_s, span->end_s));
  }
  return text;
}

}  // namespace

std::string to_json(const Inspection& inspection, const std::string& file) {
  const FileInfo& info = inspection.info;
  Json json{{"schema", "slipfit.info/1"}, {"version", SLIPFIT_VERSION}, {"file", file}};
  json["columns"] = Json::array();
  for (const ColumnInfo& column : info.columns) {
    json["columns"].push_back({{"index", column.index},
                               {"name", text_or_null(column.name)},
                               {"unit", text_or_null(column.unit)},
                               {"quantity", text_or_null(column.quantity)}});
  }
  json["rows"] = info.rows;
  json["sample_rate_Hz"] = known_or_null(info.sample_rate_Hz);
  json["steps"] = Json::array();
  for (const StepInfo& step : info.steps) json["steps"].push_back(json_of(step));
  json["strokes"] = info.strokes;
  json["sliding_s"] = Json::array();
  if (const auto& span = inspection.sliding) json["sliding_s"].push_back({span->begin_s, span->end_s});
  json["taken"] = {{"time_column", known_or_null(info.taken.time_column)},
                   {"force_column", known_or_null(info.taken.force_column)},
                   {"normal_force_column", known_or_null(info.taken.normal_force_column)},
                   {"speed_m_per_s", known_or_null(info.taken.speed_m_per_s)}};
  json["assumed"] = info.assumed;
  json["refusal"] = info.refusal ? Json(info.refusal->message) : Json();
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string to_text(const Inspection& inspection, const std::string& file) {
  const FileInfo& info = inspection.info;
  std::string text = fmt::format("{}: {} rows of {} columns\n\nColumns\n", file, info.rows, info.columns.size());
  for (const ColumnInfo& column : info.columns) {
    text += fmt::format("  {:<4} {:<24} {:<8} {}\n", column.index, column.name, column.unit, column.quantity);
  }
  text += info_steps_text(info.steps) + info_taken_text(inspection);
  if (!info.assumed.empty()) text += "\nAssumed while reading\n";
  for (const std::string& sentence : info.assumed) text += "  - " + sentence + "\n";
  if (info.refusal) text += "\nNot read as it is: " + info.refusal->message + "\n";
  return text;
}

}  // namespace slipfit
