#include "slipfit/report/info.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "report/blocks.hpp"
#include "report/json_values.hpp"
#include "slipfit/core/printable.hpp"

namespace slipfit {
namespace {

Json column_json(const ColumnInfo& column) {
  return {{"index", column.index},
          {"name", text_or_null(column.name)},
          {"unit", text_or_null(column.unit)},
          {"quantity", text_or_null(column.quantity)}};
}

Json step_json(const StepInfo& step) {
  return {{"step", step.step},
          {"rows", {step.rows.first, step.rows.last}},
          {"time_s", step.time_s ? Json{step.time_s->begin_s, step.time_s->end_s} : Json()},
          {"speed_m_per_s", step.speed_m_per_s},
          {"normal_force_N", step.normal_force_N}};
}

/// Returns the tables that --sheet or --variable can select, if there are several.
std::string tables_text(const char* heading, const std::vector<std::string>& names) {
  constexpr std::size_t kMostShown = 50;
  if (names.size() < 2) return {};
  std::string text = fmt::format("\n{}\n", heading);
  for (std::size_t i = 0; i < std::min(names.size(), kMostShown); ++i) text += "  " + printable(names[i]) + "\n";
  if (names.size() > kMostShown) text += fmt::format("  ... and {} more\n", names.size() - kMostShown);
  return text;
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
  Json sliding = Json::array();
  if (const auto& span = inspection.sliding) sliding.push_back({span->begin_s, span->end_s});
  return text_of(Json{{"schema", "slipfit.info/1"},
                      {"version", SLIPFIT_VERSION},
                      {"file", file},
                      {"sheets", info.sheets},
                      {"variables", info.variables},
                      {"columns", array_of(info.columns, column_json)},
                      {"rows", info.rows},
                      {"sample_rate_Hz", info.sample_rate_Hz},
                      {"steps", array_of(info.steps, step_json)},
                      {"strokes", info.strokes},
                      {"sliding_s", sliding},
                      {"taken",
                       {{"time_column", info.taken.time_column},
                        {"force_column", info.taken.force_column},
                        {"normal_force_column", info.taken.normal_force_column},
                        {"speed_m_per_s", info.taken.speed_m_per_s}}},
                      {"assumed", info.assumed},
                      {"refusal", info.refusal ? Json(info.refusal->message) : Json()}});
}

std::string to_text(const Inspection& inspection, const std::string& file) {
  const FileInfo& info = inspection.info;
  std::string text =
      fmt::format("{}: {} rows of {} columns\n\nColumns\n", printable(file), info.rows, info.columns.size());
  for (const ColumnInfo& column : info.columns) {
    text += fmt::format("  {:<4} {:<24} {:<8} {}\n", column.index, printable(column.name), printable(column.unit),
                        column.quantity);
  }
  text += tables_text("Sheets (--sheet)", info.sheets) + tables_text("Variables (--variable)", info.variables);
  text += info_steps_text(info.steps) + info_taken_text(inspection);
  text += assumed_text(info.assumed);
  if (info.refusal) text += "\nCannot be read without options: " + printable(info.refusal->message) + "\n";
  return text;
}

}  // namespace slipfit
