#include "report/html/batch_row.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "report/html/markup.hpp"
#include "report/json_values.hpp"
#include "report/rounding.hpp"
#include "report/text_sections.hpp"

namespace slipfit::html {
namespace {

/// One SI unit a column: rows compare by eye.
struct Column {
  const char* heading;
  const char* unit;
  double per_SI;
  Estimate BatchEntry::*quantity;
};

constexpr std::array<Column, 4> kColumns{{{"frequency", "Hz", 1.0, &BatchEntry::frequency_Hz},
                                          {"spacing V/f", "mm", 1e3, &BatchEntry::spacing_m},
                                          {"stiffness", "N/m", 1.0, &BatchEntry::stiffness_N_per_m},
                                          {"damping ratio", "-", 1.0, &BatchEntry::damping_ratio}}};

/// null where it is absent, or `json` is no object: documents come from files.
Json child(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found == json.end() ? Json() : *found;
}

std::string text_in(const Json& json, const char* key) {
  const Json found = child(json, key);
  return found.is_string() ? found.get<std::string>() : std::string();
}

std::optional<double> number_in(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_number() ? std::optional(found->get<double>()) : std::nullopt;
}

Estimate estimate_in(const Json& json, const char* value, const char* error, const char* interval) {
  Estimate estimate{number_in(json, value), number_in(json, error), {}, {}};
  const auto bounds = json.find(interval);
  if (bounds != json.end() && bounds->is_array() && bounds->size() == 2 && (*bounds)[0].is_number() &&
      (*bounds)[1].is_number()) {
    estimate.ci95 = Interval{(*bounds)[0].get<double>(), (*bounds)[1].get<double>()};
  }
  return estimate;
}

/// Empty where it is absent; a bounded parameter keeps its interval alone.
Estimate member(const Json& document, const char* section, const char* name) {
  const Json quantity = child(child(document, section), name);
  Estimate estimate = estimate_in(quantity, "value", "se", "ci95");
  const std::string status = text_in(quantity, "status");
  if (status == "bounded" || status == "unidentified") estimate.value.reset();
  return estimate;
}

/// A relative file as an address: everything but letters, digits and -_./~ as %XX.
std::string address(const std::string& file) {
  std::string result = "./";
  for (const char c : file) {
    const bool is_plain =
        std::isalnum(static_cast<unsigned char>(c)) != 0 || std::string("-_./~").find(c) != std::string::npos;
    result += is_plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return result;
}

std::string spark(const std::vector<double>& heights) {
  if (heights.size() < 2) return {};
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  const double scale = *high > *low ? 26.0 / (*high - *low) : 0.0;
  std::string path;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    path += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L",
                        120.0 * static_cast<double>(i) / static_cast<double>(heights.size() - 1),
                        28.0 - scale * (heights[i] - *low));
  }
  return "<svg class=\"spark\" viewBox=\"0 0 120 30\" preserveAspectRatio=\"none\" role=\"img\" "
         "aria-label=\"trace\"><path "
         "d=\"" +
         path + "\"/></svg>";
}

std::string quantity_cell(const Estimate& SI, double per_SI) {
  const RoundedEstimate shown = rounded(scaled(SI, per_SI));
  const std::string interval = shown.interval == "-" ? "" : "<small>" + text(shown.interval) + "</small>";
  const std::string value = SI.value ? fmt::format("{}", *SI.value) : std::string();
  return fmt::format("<td class=\"number\" data-value=\"{}\">{}{}</td>", value, text(shown.value), interval);
}

std::string heading(const std::string& words, const char* css_class) {
  return fmt::format("<th scope=\"col\" class=\"{}\"><button type=\"button\">{}</button></th>", css_class, text(words));
}

}  // namespace

Result<BatchEntry> batch_entry(const BatchPageRow& row) {
  const Json document = Json::parse(row.document, nullptr, false);
  const bool is_fit = text_in(document, "schema") == "slipfit.fit/1" && !text_in(document, "id").empty() &&
                      !text_in(document, "status").empty();
  if (!is_fit) {
    return Error{"bad_document",
                 fmt::format("'{}': no fit document, expected one line of results.jsonl", row.document.substr(0, 60))};
  }
  BatchEntry entry;
  entry.id = text_in(document, "id");
  entry.status = text_in(document, "status");
  entry.speed_m_per_s = number_in(child(document, "recording"), "speed_m_per_s");
  entry.frequency_Hz = estimate_in(child(document, "frequency"), "value_Hz", "se_Hz", "ci95_Hz");
  entry.spacing_m = member(document, "derived", "pattern_spacing_m");
  entry.stiffness_N_per_m = member(document, "parameters", "stiffness_N_per_m");
  entry.damping_ratio = member(document, "parameters", "damping_ratio");
  entry.warnings = child(document, "warnings").size();
  entry.report_file = row.report_file;
  entry.sparkline = row.sparkline;
  return entry;
}

std::string batch_headings() {
  std::string cells = heading("recording", "") + "<th scope=\"col\">trace</th>" + heading("shows", "") +
                      heading("speed [mm/s]", "number");
  for (const Column& column : kColumns) cells += heading(fmt::format("{} [{}]", column.heading, column.unit), "number");
  return "<thead><tr>" + cells + heading("warnings", "number") + "</tr></thead>\n";
}

std::string batch_row(const BatchEntry& entry) {
  std::string name = text(entry.id);
  if (!entry.report_file.empty()) name = fmt::format("<a href=\"{}\">{}</a>", address(entry.report_file), name);
  std::string words = entry.status;
  std::replace(words.begin(), words.end(), '_', '-');
  const std::string speed = entry.speed_m_per_s ? fmt::format("{}", *entry.speed_m_per_s) : std::string();
  std::string cells =
      fmt::format("<td class=\"name\">{}</td><td>{}</td><td>{}</td><td class=\"number\" data-value=\"{}\">{}</td>",
                  name, spark(entry.sparkline), text(words), speed,
                  entry.speed_m_per_s ? fmt::format("{:.6g}", 1e3 * *entry.speed_m_per_s) : std::string("-"));
  for (const Column& column : kColumns) cells += quantity_cell(entry.*column.quantity, column.per_SI);
  cells += fmt::format("<td class=\"number\" data-value=\"{0}\">{0}</td>", entry.warnings);
  return fmt::format("<tr data-status=\"{}\">{}</tr>\n", text(entry.status), cells);
}

}  // namespace slipfit::html
