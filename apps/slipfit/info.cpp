#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "failure.hpp"
#include "output.hpp"
#include "recording_options.hpp"
#include "slipfit/io/file_info.hpp"
#include "slipfit/pipeline.hpp"

namespace {

using Json = nlohmann::ordered_json;

/// What the file holds, and what slides in the part that would be read.
struct Inspection {
  slipfit::FileInfo info;
  std::vector<slipfit::TimeSpan> sliding_s;
};

/// Where slips are does not hang on the speed: any will do where the file has none.
Inspection inspect(const RecordingArguments& arguments) {
  const slipfit::ReadOptions options = read_options_from(arguments);
  auto info = slipfit::inspect_recording(arguments.files.front(), options);
  if (!info) throw Failure(ExitCode::BadRecording, info.error());
  Inspection inspection{std::move(info).value(), {}};
  if (const auto& recording = inspection.info.recording) {
    inspection.sliding_s.push_back(slipfit::analyze(*recording).sliding);
  }
  return inspection;
}

template <class Value>
Json known(const std::optional<Value>& value) {
  return value ? Json(*value) : Json();
}

Json text_or_null(const std::string& text) {
  return text.empty() ? Json() : Json(text);
}

Json to_json(const slipfit::StepInfo& step) {
  return {{"step", step.step},
          {"rows", {step.rows.first, step.rows.last}},
          {"time_s", step.time_s ? Json{step.time_s->begin_s, step.time_s->end_s} : Json()},
          {"speed_m_per_s", known(step.speed_m_per_s)},
          {"normal_force_N", known(step.normal_force_N)}};
}

std::string to_json(const Inspection& inspection, const std::string& file) {
  const slipfit::FileInfo& info = inspection.info;
  Json json{{"schema", "slipfit.info/1"}, {"version", SLIPFIT_VERSION}, {"file", file}};
  json["columns"] = Json::array();
  for (const slipfit::ColumnInfo& column : info.columns) {
    json["columns"].push_back({{"index", column.index},
                               {"name", text_or_null(column.name)},
                               {"unit", text_or_null(column.unit)},
                               {"quantity", text_or_null(column.quantity)}});
  }
  json["rows"] = info.rows;
  json["sample_rate_Hz"] = known(info.sample_rate_Hz);
  json["steps"] = Json::array();
  for (const slipfit::StepInfo& step : info.steps) json["steps"].push_back(to_json(step));
  json["strokes"] = info.strokes;
  json["sliding_s"] = Json::array();
  for (const slipfit::TimeSpan& span : inspection.sliding_s) json["sliding_s"].push_back({span.begin_s, span.end_s});
  json["taken"] = {{"time_column", known(info.taken.time_column)},
                   {"force_column", known(info.taken.force_column)},
                   {"normal_force_column", known(info.taken.normal_force_column)},
                   {"speed_m_per_s", known(info.taken.speed_m_per_s)}};
  json["assumed"] = info.assumed;
  json["refusal"] = info.refusal ? Json(info.refusal->message) : Json();
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string steps_text(const std::vector<slipfit::StepInfo>& steps) {
  constexpr std::size_t kMostShown = 50;
  std::string text = fmt::format("\nSteps\n");
  for (std::size_t i = 0; i < std::min(steps.size(), kMostShown); ++i) {
    const slipfit::StepInfo& step = steps[i];
    text += fmt::format("  {:<4} rows {} to {}", step.step, step.rows.first, step.rows.last);
    if (step.time_s) text += fmt::format(", {:.6g} to {:.6g} s", step.time_s->begin_s, step.time_s->end_s);
    if (step.speed_m_per_s) text += fmt::format(", {:.6g} m/s", *step.speed_m_per_s);
    if (step.normal_force_N) text += fmt::format(", normal force {:.6g} N", *step.normal_force_N);
    text += "\n";
  }
  if (steps.size() > kMostShown) text += fmt::format("  ... and {} more\n", steps.size() - kMostShown);
  return text;
}

std::string taken_text(const Inspection& inspection) {
  const slipfit::FileInfo& info = inspection.info;
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
  for (const slipfit::TimeSpan& span : inspection.sliding_s) {
    add("slides", fmt::format("{:.6g} to {:.6g} s", span.begin_s, span.end_s));
  }
  return text;
}

std::string to_text(const Inspection& inspection, const std::string& file) {
  const slipfit::FileInfo& info = inspection.info;
  std::string text = fmt::format("{}: {} rows of {} columns\n\nColumns\n", file, info.rows, info.columns.size());
  for (const slipfit::ColumnInfo& column : info.columns) {
    text += fmt::format("  {:<4} {:<24} {:<8} {}\n", column.index, column.name, column.unit, column.quantity);
  }
  text += steps_text(info.steps) + taken_text(inspection);
  if (!info.assumed.empty()) text += "\nAssumed while reading\n";
  for (const std::string& sentence : info.assumed) text += "  - " + sentence + "\n";
  if (info.refusal) text += "\nNot read as it is: " + info.refusal->message + "\n";
  return text;
}

struct InfoArguments {
  RecordingArguments recording;
  DocumentOptions document;
};

void run(const InfoArguments& arguments) {
  const std::string& file = only_file(arguments.recording);
  check_outputs(arguments.document.outputs, file);
  const Inspection inspection = inspect(arguments.recording);
  write_results(arguments.document, [&](const std::string&) {
    return arguments.document.json ? to_json(inspection, file) : to_text(inspection, file);
  });
}

}  // namespace

void add_info_command(CLI::App& program) {
  CLI::App* const command =
      program.add_subcommand("info", "What a file holds: columns, units, clock, steps; and what would be read of it");
  const auto arguments = std::make_shared<InfoArguments>();
  command->add_option("FILE", arguments->recording.files, "Recording")->required();
  add_options_where(*command, arguments->recording, [](const slipfit::RecordingOption& option) {
    return option.of == slipfit::RecordingOption::Of::Reading;
  });
  add_document_options(*command, arguments->document, "text");
  command->callback([arguments] { run(*arguments); });
}
