#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <span>

#include "chart/chart.hpp"
#include "core/counted.hpp"
#include "report/batch_html.hpp"
#include "report/document/json_node.hpp"
#include "report/html/assets.hpp"
#include "report/html/figure.hpp"
#include "report/html/page.hpp"
#include "report/quantity_rows.hpp"

namespace slipfit {
namespace html {
namespace {

using documents::JsonNode;

/// A quantity of the table, in one unit so that rows compare by eye, and of the distributions.
struct BatchColumn {
  std::string_view key;  ///< of the document
  const char* unit = nullptr;
  double per_SI = 1.0;

  [[nodiscard]] std::string heading() const { return label_with_unit(std::string(quantity_with_key(key).words), unit); }
};

constexpr std::array<BatchColumn, 5> kColumns{{{"frequency_Hz", "Hz", 1.0},
                                               {"pattern_spacing_m", "mm", 1e3},
                                               {"stiffness_N_per_m", "N/m", 1.0},
                                               {"friction_difference_N", "N", 1.0},
                                               {"damping_ratio", "-", 1.0}}};

constexpr std::size_t kMostRows = 10000;
constexpr std::size_t kRowsAtOnce = 500;         // laid out; the script shows more of them on demand
constexpr std::size_t kFewest = 5;               // values that make a distribution
constexpr double kDistributionWidth_px = 290.0;  // of a distribution: with its numbers it fills a telephone
constexpr double kLeastShare = 1e-6;             // of the greatest: below it a value is as good as zero

/// Statuses with their counts, from the most to the least frequent.
using StatusCounts = std::vector<std::pair<std::string, std::size_t>>;

bool is_group(const BatchPageRow& row) {
  return row.id.starts_with("group:");
}

StatusCounts statuses_of(const std::vector<BatchPageRow>& rows) {
  std::map<std::string, std::size_t> counts;
  for (const BatchPageRow& row : rows) counts[row.status] += is_group(row) ? 0U : 1U;
  StatusCounts sorted(counts.begin(), counts.end());
  std::ranges::stable_sort(sorted, [](const auto& a, const auto& b) { return a.second > b.second; });
  return sorted;
}

std::string summary_of(const BatchPage& page, const StatusCounts& counts) {
  const auto groups = static_cast<std::size_t>(std::ranges::count_if(page.rows, is_group));
  std::string sentence = counted(page.rows.size() - groups, "recording");
  const char* separator = ": ";
  for (const auto& [status, count] : counts) {
    if (count == 0) continue;
    sentence += fmt::format("{}{} {}", separator, count, plain_words(status));
    separator = ", ";
  }
  if (groups > 0) sentence += "; " + counted(groups, "group");
  if (!page.failures.empty()) sentence += fmt::format("; {} failed", page.failures.size());
  return text(sentence + ".");
}

/// Equal steps of the logarithm: the quantities are positive and spread over decades. What has no place on it is
/// counted.
std::optional<chart::Panel> histogram(std::vector<double> values, std::string label) {
  if (values.empty()) return std::nullopt;
  const double least = kLeastShare * *std::ranges::max_element(values);
  const auto near_zero = std::erase_if(values, [least](double v) { return !(v > least); });
  if (values.size() < kFewest) return std::nullopt;
  if (near_zero > 0) label += fmt::format(", {} at zero not drawn", near_zero);
  const auto [low, high] = std::ranges::minmax_element(values);
  const double first = *low / 1.05;
  const auto bins =
      static_cast<std::size_t>(std::clamp(2.0 * std::cbrt(static_cast<double>(values.size())), 6.0, 40.0));
  const double step = std::log(*high * 1.05 / first) / static_cast<double>(bins);
  std::vector<double> counts(bins, 0.0);
  for (const double value : values) {
    counts[std::min(bins - 1, static_cast<std::size_t>(std::log(value / first) / step))] += 1.0;
  }
  chart::Panel panel{.x = {label, first, first * std::exp(step * static_cast<double>(bins)), chart::Scale::Logarithmic},
                     .y = {"recordings", 0.0, 1.1 * *std::ranges::max_element(counts)},
                     .height_px = 160.0};
  for (std::size_t i = 0; i < bins; ++i) {
    const double left = first * std::exp(step * static_cast<double>(i));
    const double right = left * std::exp(step);
    panel.areas.push_back(rectangle("", chart::Colour::Blue, {left, 0.0}, {right, counts[i]}));
  }
  return panel;
}

std::string distributions(const std::vector<BatchPageRow>& rows) {
  std::string figures;
  for (std::size_t i = 0; i < kColumns.size(); ++i) {
    const BatchColumn& column = kColumns[i];
    std::vector<double> values;
    for (const BatchPageRow& row : rows) {
      const std::optional<double>& value = row.quantities[i].estimate.value;
      if (!is_group(row) && value) values.push_back(column.per_SI * *value);
    }
    const std::string label = column.heading();
    const auto panel = histogram(std::move(values), label);
    if (!panel) continue;
    const std::string picture = picture_of(chart::Chart{"", {}, {*panel}, kDistributionWidth_px},
                                           std::string(column.key), "histogram of the " + label);
    figures += "<figure>" + picture + "</figure>\n";
  }
  if (figures.empty()) return {};
  return section("", "Distributions",
                 "<p class=\"guide\">Number of recordings with each value, of those in which it is known.</p>\n<div "
                 "class=\"charts\">\n" +
                     figures + "</div>\n");
}

/// Returns a note for a table that shows only its first rows.
std::string left_out_part(std::size_t rows, const char* file) {
  return rows <= kMostRows ? ""
                           : fmt::format("<p>{} more are in {} and not in this table.</p>\n", rows - kMostRows, file);
}

std::string failures_part(const std::vector<BatchPageFailure>& failures) {
  if (failures.empty()) return {};
  std::vector<std::vector<Cell>> rows;
  for (const BatchPageFailure& failure : std::span(failures).first(std::min(kMostRows, failures.size()))) {
    rows.push_back({text(failure.id), text(failure.message), "<code>" + text(failure.code) + "</code>"});
  }
  return section(" class=\"flows\"", "Failures",
                 table(" id=\"failures\"", {"recording", "reason", "code"}, rows) +
                     left_out_part(failures.size(), "failures.csv"));
}

constexpr std::size_t kSparkColumns = 60;
constexpr double kSparkWidth = 120.0;
constexpr double kSparkHeight = 26.0;

std::vector<std::string> codes_in(const JsonNode& document) {
  std::vector<std::string> codes;
  for (const Warning& warning : documents::warnings_in(document)) {
    if (std::ranges::find(codes, warning.code) == codes.end()) codes.push_back(warning.code);
  }
  return codes;
}

BatchPageRow row_from(const JsonNode& document) {
  BatchPageRow row;
  row.id = document.member("id").text();
  row.status = document.member("status").text();
  if (const auto recording = document.known("recording")) row.speed_m_per_s = recording->number_at("speed_m_per_s");
  for (std::size_t i = 0; i < kColumns.size(); ++i)
    row.quantities[i] =
        documents::quantity_in(document, quantity_with_key(kColumns[i].key)).value_or(documents::DocumentQuantity{});
  row.warnings = codes_in(document);
  return row;
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

std::string batch_headings() {
  std::string cells = heading("recording", "") + "<th scope=\"col\">trace</th>" + heading("shows", "") +
                      heading("speed [mm/s]", "number");
  for (const BatchColumn& column : kColumns) {
    cells += heading(column.heading(), "number");
  }
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
  for (std::size_t i = 0; i < kColumns.size(); ++i) {
    const Cell cell = quantity_cell(row.quantities[i].estimate, kColumns[i].per_SI, row.quantities[i].status);
    cells += fmt::format("<td class=\"number\"{}>{}</td>", cell.attributes, cell.content);
  }
  std::string codes;
  for (const std::string& code : row.warnings) codes += "<span>" + text(code) + " </span>";
  cells += fmt::format("<td class=\"codes\">{}</td>", codes);
  return fmt::format("<tr data-status=\"{}\">{}</tr>\n", text(row.status), cells);
}

std::string table_of(const std::vector<BatchPageRow>& rows) {
  std::string at_once;
  std::string later;
  for (std::size_t i = 0; i < std::min(kMostRows, rows.size()); ++i) {
    (i < kRowsAtOnce ? at_once : later) += batch_row(rows[i]);
  }
  return "<table id=\"recordings\">" + batch_headings() + "<tbody>\n" + at_once + "</tbody></table>\n<template " +
         "id=\"later\">" + later + "</template>\n";
}

std::string options_of(const StatusCounts& counts) {
  std::string options;
  for (const auto& [status, count] : counts) {
    options += fmt::format("<option value=\"{}\">{} ({})</option>", text(status), text(plain_words(status)), count);
  }
  return options;
}

}  // namespace
}  // namespace html

std::string to_html(const BatchPage& page) {
  const html::StatusCounts counts = html::statuses_of(page.rows);
  html::PageParts parts;
  parts.title = page.title;
  parts.kind = "batch";
  parts.headline = html::summary_of(page, counts);
  parts.main = fmt::format(fmt::runtime(assets::table_part()), fmt::arg("statuses", html::options_of(counts)),
                           fmt::arg("table", html::table_of(page.rows)),
                           fmt::arg("left_out", html::left_out_part(page.rows.size(), "results.jsonl"))) +
               html::distributions(page.rows) + html::failures_part(page.failures);
  parts.scripts = html::script_element(assets::table_script());
  return html::page_from(parts);
}

Result<BatchPageRow> batch_page_row(const std::string& document) {
  return documents::with_document<BatchPageRow>(document, "results.jsonl", html::row_from);
}

std::string sparkline_of(const Recording& recording) {
  const std::vector<chart::Point> points = html::envelope(recording.time_s(), recording.force(), html::kSparkColumns);
  if (points.size() < 2) return {};
  const auto is_lower = [](const chart::Point& a, const chart::Point& b) { return a.y < b.y; };
  const auto [low, high] = std::ranges::minmax_element(points, is_lower);
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
