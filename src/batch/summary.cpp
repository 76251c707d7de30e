#include "batch/summary.hpp"

#include <array>
#include <charconv>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "batch/csv_line.hpp"
#include "io/csv_fields.hpp"

namespace slipfit::batch {
namespace {

using Json = nlohmann::ordered_json;

/// The key is name + unit; the bounds of its interval are name_low + unit and name_high + unit.
struct Quantity {
  std::string_view name;
  std::string_view unit;

  [[nodiscard]] std::string key() const { return with(""); }
  [[nodiscard]] std::string with(std::string_view bound) const {
    return std::string(name) + std::string(bound) + std::string(unit);
  }
};

constexpr auto kParameters = std::to_array<Quantity>({{"stiffness", "_N_per_m"},
                                                      {"friction_difference", "_N"},
                                                      {"static_friction", "_N"},
                                                      {"kinetic_friction", "_N"},
                                                      {"natural_frequency", "_rad_per_s"},
                                                      {"mass", "_kg"},
                                                      {"damping_ratio", ""},
                                                      {"damping_coefficient", "_N_s_per_m"},
                                                      {"friction_coefficient_difference", ""},
                                                      {"static_friction_coefficient", ""},
                                                      {"kinetic_friction_coefficient", ""},
                                                      {"friction_slope", "_N_s_per_m"},
                                                      {"alpha", "_s_per_m"},
                                                      {"f0", "_N"},
                                                      {"f1", "_N"},
                                                      {"mu0", ""},
                                                      {"mu1", ""}});

constexpr auto kDerived = std::to_array<Quantity>(
    {{"pattern_spacing", "_m"}, {"periodic_displacement", "_m"}, {"critical_speed", "_m_per_s"}});

const Json& member(const Json& object, const std::string& key) {
  static const Json none;
  if (!object.is_object()) return none;
  const auto found = object.find(key);
  return found == object.end() ? none : *found;
}

/// A number keeps the digits of the document.
std::string cell(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  return value.is_null() || value.is_structured() ? std::string() : value.dump();
}

void add_interval(std::vector<std::string>& cells, const Json& bounds) {
  const bool is_interval = bounds.is_array() && bounds.size() == 2;
  cells.push_back(is_interval ? cell(bounds[0]) : "");
  cells.push_back(is_interval ? cell(bounds[1]) : "");
}

void add_estimate(std::vector<std::string>& cells, const Json& estimate) {
  cells.push_back(cell(member(estimate, "value")));
  add_interval(cells, member(estimate, "ci95"));
}

void add_names(std::vector<std::string>& names, const Quantity& quantity) {
  names.insert(names.end(), {quantity.key(), quantity.with("_low"), quantity.with("_high")});
}

std::string warning_codes(const Json& warnings) {
  std::string codes;
  for (const Json& warning : warnings) {
    codes += (codes.empty() ? "" : " ") + cell(member(warning, "code"));
  }
  return codes;
}

std::vector<std::string> names() {
  std::vector<std::string> names{"row",
                                 "id",
                                 "group",
                                 "file",
                                 "status",
                                 "speed_m_per_s",
                                 "cycles",
                                 "frequency_Hz",
                                 "frequency_low_Hz",
                                 "frequency_high_Hz"};
  for (const Quantity& quantity : kDerived) add_names(names, quantity);
  names.insert(names.end(), {"regime", "measured_spacing_En", "tier", "residual_rms_N"});
  for (const Quantity& quantity : kParameters) {
    add_names(names, quantity);
    names.push_back(std::string(quantity.name) + "_status");
  }
  names.insert(names.end(), {"warnings", "error"});
  return names;
}

std::vector<std::string> key_cells(const SummaryKey& key, const std::string& status) {
  return {std::to_string(key.row), text_cell(key.id), text_cell(key.group), text_cell(key.file), status};
}

}  // namespace

std::string summary_names() {
  return csv_line(names());
}

Result<std::string> summary_of_result(const SummaryKey& key, const std::string& document) {
  const Json json = Json::parse(document, nullptr, false);
  if (!json.is_object()) return Error{"not_readable", "results.jsonl: the line of '" + key.id + "' is no document"};
  std::vector<std::string> cells = key_cells(key, cell(member(json, "status")));
  cells.push_back(cell(member(member(json, "recording"), "speed_m_per_s")));
  cells.push_back(cell(member(member(json, "cycles"), "count")));
  const Json& frequency = member(json, "frequency");
  cells.push_back(cell(member(frequency, "value_Hz")));
  add_interval(cells, member(frequency, "ci95_Hz"));
  const Json& derived = member(json, "derived");
  for (const Quantity& quantity : kDerived) add_estimate(cells, member(derived, quantity.key()));
  cells.push_back(cell(member(derived, "regime")));
  cells.push_back(cell(member(member(derived, "measured_spacing_En"), "value")));
  const Json& model = member(json, "model");
  cells.push_back(cell(member(model, "tier")));
  cells.push_back(cell(member(member(model, "residual"), "rms_N")));
  for (const Quantity& quantity : kParameters) {
    const Json& parameter = member(member(json, "parameters"), quantity.key());
    add_estimate(cells, parameter);
    cells.push_back(cell(member(parameter, "status")));
  }
  cells.push_back(warning_codes(member(json, "warnings")));
  cells.emplace_back();
  return csv_line(cells);
}

std::string summary_of_failure(const SummaryKey& key, const std::string& code) {
  static const std::size_t columns = names().size();
  std::vector<std::string> cells = key_cells(key, "failed");
  cells.resize(columns);
  cells.back() = code;
  return csv_line(cells);
}

std::optional<SummaryPlace> place_of(const std::string& summary_line) {
  const auto cells = reading::csv_fields(summary_line, ',');
  if (!cells || cells->size() < 5) return std::nullopt;
  SummaryPlace place;
  const std::string& row = cells->front();
  if (std::from_chars(row.data(), row.data() + row.size(), place.row).ec != std::errc()) return std::nullopt;
  place.is_group = (*cells)[1].starts_with("group:");
  place.has_failed = (*cells)[4] == "failed";
  return place;
}

}  // namespace slipfit::batch
