#include "report/html/batch_row.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "report/format.hpp"
#include "report/html/markup.hpp"
#include "report/html/page.hpp"
#include "report/html/scaling.hpp"
#include "report/json_values.hpp"
#include "report/text_sections.hpp"

namespace slipfit {
namespace html {
namespace {

constexpr std::size_t kSparkColumns = 60;
constexpr double kSparkWidth = 120.0;
constexpr double kSparkHeight = 26.0;

std::vector<std::string> codes_in(const Json& warnings) {
  std::vector<std::string> codes;
  for (const Json& warning : warnings) {
    std::string code = text_in(warning, "code");
    if (std::find(codes.begin(), codes.end(), code) == codes.end()) codes.push_back(std::move(code));
  }
  return codes;
}

/// Empty where it is absent; a bounded parameter keeps its interval alone.
Estimate member(const Json& document, const char* section, const char* name) {
  const Json quantity = child(child(document, section), name);
  Estimate estimate = estimate_in(quantity);
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

std::string spark(const std::string& path) {
  if (path.empty()) return {};
  return "<svg class=\"spark\" viewBox=\"0 -2 120 30\" preserveAspectRatio=\"none\" role=\"img\" "
         "aria-label=\"trace\"><path d=\"" +
         text(path) + "\"/></svg>";
}

std::string heading(const std::string& words, const char* css_class) {
  // data-words: no browser prints a button again on the next page
  return fmt::format(R"(<th scope="col" class="{}" data-words="{}"><button type="button">{}</button></th>)", css_class,
                     text(words), text(words));
}

}  // namespace

std::string batch_headings() {
  std::string cells = heading("recording", "") + "<th scope=\"col\">trace</th>" + heading("shows", "") +
                      heading("speed [mm/s]", "number");
  for (const BatchColumn& column : kBatchColumns)
    cells += heading(label_with_unit(column.heading, column.unit), "number");
  return "<thead><tr>" + cells + heading("warnings", "") + "</tr></thead>\n";
}

std::string batch_row(const BatchPageRow& row) {
  std::string name = text(row.id);
  if (!row.report_file.empty()) name = fmt::format("<a href=\"{}\">{}</a>", address(row.report_file), name);
  const std::string speed = row.speed_m_per_s ? fmt::format("{}", *row.speed_m_per_s) : std::string();
  std::string cells = fmt::format(
      R"(<td class="name">{}</td><td>{}</td><td class="shows">{}</td><td class="number" data-value="{}">{}</td>)", name,
      spark(row.sparkline), text(plain_words(row.status)), speed,
      row.speed_m_per_s ? fmt::format("{:.6g}", 1e3 * *row.speed_m_per_s) : std::string("-"));
  for (const BatchColumn& column : kBatchColumns) {
    const std::string status = column.parameter_status != nullptr ? row.*column.parameter_status : std::string();
    cells += quantity_cell(row.*column.quantity, column.per_SI, status);
  }
  std::string codes;
  for (const std::string& code : row.warnings) codes += "<span>" + text(code) + " </span>";
  cells += fmt::format("<td class=\"codes\">{}</td>", codes);
  return fmt::format("<tr data-status=\"{}\">{}</tr>\n", text(row.status), cells);
}

}  // namespace html

Result<BatchPageRow> batch_page_row(const std::string& document) {
  using namespace html;
  const Json json = Json::parse(document, nullptr, false);
  BatchPageRow row;
  row.id = text_in(json, "id");
  row.status = text_in(json, "status");
  if (text_in(json, "schema") != "slipfit.fit/1" || row.id.empty() || row.status.empty()) {
    return Error{"bad_document",
                 fmt::format("'{}': no fit document, expected one line of results.jsonl", document.substr(0, 60))};
  }
  row.speed_m_per_s = number_in(child(json, "recording"), "speed_m_per_s");
  row.frequency_Hz = estimate_in(child(json, "frequency"), "_Hz");
  row.spacing_m = member(json, "derived", "pattern_spacing_m");
  row.stiffness_N_per_m = member(json, "parameters", "stiffness_N_per_m");
  row.friction_difference_N = member(json, "parameters", "friction_difference_N");
  row.damping_ratio = member(json, "parameters", "damping_ratio");
  const auto status_of = [&](const char* name) { return text_in(child(child(json, "parameters"), name), "status"); };
  row.stiffness_status = status_of("stiffness_N_per_m");
  row.difference_status = status_of("friction_difference_N");
  row.damping_status = status_of("damping_ratio");
  row.warnings = codes_in(child(json, "warnings"));
  return row;
}

std::string sparkline_of(const Recording& recording) {
  const std::vector<chart::Point> points = html::envelope(recording.time_s(), recording.force(), html::kSparkColumns);
  if (points.size() < 2) return {};
  const auto is_lower = [](const chart::Point& a, const chart::Point& b) { return a.y < b.y; };
  const auto [low, high] = std::minmax_element(points.begin(), points.end(), is_lower);
  const double scale = high->y > low->y ? html::kSparkHeight / (high->y - low->y) : 0.0;
  std::string path;
  long last_x = 0;
  long last_y = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const long x = std::lround(html::kSparkWidth * static_cast<double>(i) / static_cast<double>(points.size() - 1));
    const long y = std::lround(html::kSparkHeight - scale * (points[i].y - low->y));
    const char step = i == 0 ? 'M' : i == 1 ? 'l' : ' ';
    path += fmt::format("{}{}{}{}", step, x - last_x, y < last_y ? "" : " ", y - last_y);
    last_x = x;
    last_y = y;
  }
  return path;
}

}  // namespace slipfit
