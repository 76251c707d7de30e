#include "batch/tables.hpp"

#include <charconv>
#include <nlohmann/json.hpp>
#include <string_view>

#include "core/csv_line.hpp"
#include "core/thrown_error.hpp"
#include "io/cells.hpp"
#include "report/quantity_rows.hpp"
#include "slipfit/core/printable.hpp"
#include "slipfit/fit/parameter.hpp"

namespace slipfit::batch {
namespace {

using Json = nlohmann::ordered_json;

/// A column of summary.csv and where the document holds its value.
struct SummaryColumn {
  std::string name;
  Json::json_pointer place;
};

/// Value, bounds and standard error of an estimate: "low", "high" and "se" precede the unit in the name.
void add_estimate(std::vector<SummaryColumn>& columns, const std::string& place, const std::string& name,
                  const std::string& suffix) {
  columns.push_back({name + suffix, Json::json_pointer(place + "/value")});
  columns.push_back({name + "_low" + suffix, Json::json_pointer(place + "/ci95/0")});
  columns.push_back({name + "_high" + suffix, Json::json_pointer(place + "/ci95/1")});
  columns.push_back({name + "_se" + suffix, Json::json_pointer(place + "/se")});
}

std::vector<SummaryColumn> make_columns() {
  using Place = Json::json_pointer;
  std::vector<SummaryColumn> columns{
      {"input_digest", Place("/recording/input_digest")},     {"speed_m_per_s", Place("/recording/speed_m_per_s")},
      {"normal_force_N", Place("/recording/normal_force_N")}, {"cycles", Place("/cycles/count")},
      {"frequency_Hz", Place("/frequency/value_Hz")},         {"frequency_low_Hz", Place("/frequency/ci95_Hz/0")},
      {"frequency_high_Hz", Place("/frequency/ci95_Hz/1")},   {"frequency_se_Hz", Place("/frequency/se_Hz")}};
  add_estimate(columns, "/derived/pattern_spacing_m", "pattern_spacing", "_m");
  add_estimate(columns, "/derived/periodic_displacement_m", "periodic_displacement", "_m");
  add_estimate(columns, "/derived/critical_speed_m_per_s", "critical_speed", "_m_per_s");
  for (const auto& row : kCoefficients) {
    add_estimate(columns, "/coefficients/" + std::string(row.key), std::string(row.key), "");
  }
  columns.push_back({"regime", Place("/derived/regime")});
  columns.push_back({"measured_spacing_En", Place("/derived/measured_spacing_En/value")});
  add_estimate(columns, "/derived/surface_spacing_m", "surface_spacing", "_m");
  columns.push_back({"surface_En", Place("/derived/surface_En/value")});
  columns.push_back({"surface_verdict", Place("/derived/surface_verdict")});
  columns.push_back({"tier", Place("/model/tier")});
  columns.push_back({"residual_rms_N", Place("/model/residual/rms_N")});
  for (const ParameterInfo& parameter : parameter_table()) {
    const std::string key(parameter.key);
    const std::string suffix = suffix_of(parameter.unit);
    const std::string name = key.substr(0, key.size() - suffix.size());
    add_estimate(columns, "/parameters/" + key, name, suffix);
    columns.push_back({name + "_status", Place("/parameters/" + key + "/status")});
  }
  return columns;
}

/// Between those of the manifest with the status, and warnings and error.
const std::vector<SummaryColumn>& document_columns() {
  static const std::vector<SummaryColumn> columns = make_columns();
  return columns;
}

/// A number keeps the digits of the document.
std::string cell_at(const Json& document, const Json::json_pointer& place) {
  if (!document.contains(place)) return {};
  const Json& value = document.at(place);
  if (value.is_string()) return spreadsheet_cell(value.get<std::string>());
  return value.is_null() || value.is_structured() ? std::string() : value.dump();
}

std::string warning_codes(const Json& document) {
  std::string codes;
  for (const Json& warning : document.value("warnings", Json::array())) {
    codes += (codes.empty() ? "" : " ") + cell_at(warning, Json::json_pointer("/code"));
  }
  return codes;
}

/// "row,id,..." without "row,".
std::string without_row(const std::string& line) {
  return line.substr(line.find(',') + 1);
}

std::vector<std::string> key_cells(const SummaryKey& key, const std::string& status) {
  return {std::to_string(key.row), spreadsheet_cell(key.id), spreadsheet_cell(key.group), spreadsheet_cell(key.file),
          status};
}

}  // namespace

std::string summary_names() {
  std::vector<std::string> names{"row", "id", "group", "file", "status"};
  for (const SummaryColumn& column : document_columns()) names.push_back(column.name);
  names.insert(names.end(), {"warnings", "error"});
  return csv_line(names);
}

std::string summary_of_result(const SummaryKey& key, const std::string& document) {
  const Json json = Json::parse(document, nullptr, false);
  if (!json.is_object()) {
    throw ThrownError({"not_readable", "results.jsonl: the line of '" + printable(key.id) + "' is no document"});
  }
  std::vector<std::string> cells = key_cells(key, cell_at(json, Json::json_pointer("/status")));
  for (const SummaryColumn& column : document_columns()) cells.push_back(cell_at(json, column.place));
  cells.insert(cells.end(), {warning_codes(json), ""});
  return csv_line(cells);
}

std::string summary_names_without_row() {
  return without_row(summary_names());
}

std::string summary_without_row(const std::string& document) {
  const Json json = Json::parse(document, nullptr, false);
  const auto text_at = [&](const char* place) {
    const Json::json_pointer pointer(place);
    if (!json.is_object() || !json.contains(pointer) || !json.at(pointer).is_string()) return std::string();
    return json.at(pointer).get<std::string>();
  };
  return without_row(
      summary_of_result({0, text_at("/id"), text_at("/recording/group"), text_at("/recording/file")}, document));
}

std::string summary_of_failure(const SummaryKey& key, const std::string& code) {
  std::vector<std::string> cells = key_cells(key, "failed");
  cells.resize(cells.size() + document_columns().size() + 1);
  cells.push_back(code);
  return csv_line(cells);
}

std::optional<SummaryPlace> place_of(const std::string& summary_line) {
  const auto cells = reading::csv_fields(summary_line, ',');
  if (!cells || cells->size() < 5) return std::nullopt;
  SummaryPlace place{0, cells->at(1).starts_with("group:"), cells->at(4) == "failed"};
  const std::string& row = cells->front();
  if (std::from_chars(row.data(), row.data() + row.size(), place.row).ec != std::errc()) return std::nullopt;
  return place;
}

std::string failure_names() {
  return csv_line({"id", "code", "message"});
}

std::string failure_line(const std::string& id, const Error& failure) {
  return csv_line({spreadsheet_cell(id), printable(failure.code), spreadsheet_cell(failure.message)});
}

BatchPageFailure failure_from(const std::string& failure_line) {
  auto cells = reading::csv_fields(failure_line, ',').value_or(std::vector<std::string>());
  cells.resize(3);
  return {cells[0], cells[1], cells[2]};
}

}  // namespace slipfit::batch
