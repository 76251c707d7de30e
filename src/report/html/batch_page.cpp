#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "chart/chart.hpp"
#include "report/batch_html.hpp"
#include "report/html/assets.hpp"
#include "report/html/batch_row.hpp"
#include "report/html/markup.hpp"
#include "report/html/page.hpp"
#include "report/html/scaling.hpp"
#include "report/text_sections.hpp"

namespace slipfit {
namespace html {
namespace {

constexpr std::size_t kMostRows = 10000;
constexpr std::size_t kRowsAtOnce = 500;         // laid out; the script shows more of them on demand
constexpr std::size_t kFewest = 5;               // values that make a distribution
constexpr double kDistributionWidth_px = 290.0;  // of a distribution: with its numbers it fills a telephone
constexpr double kLeastShare = 1e-6;             // of the greatest: below it a value is as good as zero

/// From the most frequent to the rarest.
using StatusCounts = std::vector<std::pair<std::string, std::size_t>>;

bool is_group(const BatchPageRow& row) {
  return row.id.starts_with("group:");
}

StatusCounts statuses_of(const std::vector<BatchPageRow>& rows) {
  std::map<std::string, std::size_t> counts;
  for (const BatchPageRow& row : rows) counts[row.status] += is_group(row) ? 0U : 1U;
  StatusCounts sorted(counts.begin(), counts.end());
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  return sorted;
}

std::string counted(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string summary_of(const BatchPage& page, const StatusCounts& counts) {
  const auto groups = static_cast<std::size_t>(std::count_if(page.rows.begin(), page.rows.end(), is_group));
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
  const double least = kLeastShare * *std::max_element(values.begin(), values.end());
  const auto near_zero = std::erase_if(values, [least](double v) { return !(v > least); });
  if (values.size() < kFewest) return std::nullopt;
  if (near_zero > 0) label += fmt::format(", {} at zero not drawn", near_zero);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double first = *low / 1.05;
  const auto bins =
      static_cast<std::size_t>(std::clamp(2.0 * std::cbrt(static_cast<double>(values.size())), 6.0, 40.0));
  const double step = std::log(*high * 1.05 / first) / static_cast<double>(bins);
  std::vector<double> counts(bins, 0.0);
  for (const double value : values) {
    counts[std::min(bins - 1, static_cast<std::size_t>(std::log(value / first) / step))] += 1.0;
  }
  chart::Panel panel;
  panel.height_px = 160.0;
  panel.x = {label, first, first * std::exp(step * static_cast<double>(bins)), chart::Scale::Logarithmic};
  panel.y = {"recordings", 0.0, 1.1 * *std::max_element(counts.begin(), counts.end()), chart::Scale::Linear};
  for (std::size_t i = 0; i < bins; ++i) {
    const double left = first * std::exp(step * static_cast<double>(i));
    const double right = left * std::exp(step);
    panel.areas.push_back(rectangle("", chart::Colour::Blue, {left, 0.0}, {right, counts[i]}));
  }
  return panel;
}

std::string distributions(const std::vector<BatchPageRow>& rows) {
  std::string figures;
  for (const BatchColumn& column : kBatchColumns) {
    std::vector<double> values;
    for (const BatchPageRow& row : rows) {
      const std::optional<double>& value = (row.*column.quantity).value;
      if (!is_group(row) && value) values.push_back(column.per_SI * *value);
    }
    const std::string label = label_with_unit(column.heading, column.unit);
    const auto panel = histogram(std::move(values), label);
    if (!panel) continue;
    const std::string picture = picture_with_data(chart::Chart{"", {}, {*panel}, kDistributionWidth_px}, column.id,
                                                  "histogram of the " + label);
    figures += "<figure>" + picture + "</figure>\n";
  }
  if (figures.empty()) return {};
  return section("", "Distributions",
                 "<p class=\"guide\">How many recordings show which value; only those in which it is known.</p>\n"
                 "<div class=\"charts\">\n" +
                     figures + "</div>\n");
}

/// Of a table that holds the first rows alone.
std::string left_out_part(std::size_t rows, const char* file) {
  return rows <= kMostRows ? ""
                           : fmt::format("<p>{} more are in {} and not in this table.</p>\n", rows - kMostRows, file);
}

std::string failures_part(const std::vector<BatchPageFailure>& failures) {
  if (failures.empty()) return {};
  std::vector<std::vector<std::string>> rows;
  for (const BatchPageFailure& failure : std::span(failures).first(std::min(kMostRows, failures.size()))) {
    rows.push_back({text(failure.id), text(failure.message), "<code>" + text(failure.code) + "</code>"});
  }
  return section(" class=\"flows\"", "Failures",
                 table(" id=\"failures\"", {"recording", "what is wrong", "code"}, rows) +
                     left_out_part(failures.size(), "failures.csv"));
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
  parts.main =
      html::filled(assets::table_part(), {{"statuses", html::options_of(counts)},
                                          {"table", html::table_of(page.rows)},
                                          {"left_out", html::left_out_part(page.rows.size(), "results.jsonl")}}) +
      html::distributions(page.rows) + html::failures_part(page.failures);
  parts.scripts = html::script_element(assets::table_script());
  return html::page_from(parts);
}

}  // namespace slipfit
