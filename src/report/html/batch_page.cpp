#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "chart/chart.hpp"
#include "report/html/assets.hpp"
#include "report/html/batch_row.hpp"
#include "report/html/markup.hpp"
#include "report/html/scaling.hpp"
#include "slipfit/report/batch_html.hpp"

namespace slipfit {
namespace html {
namespace {

constexpr std::size_t kMostRows = 5000;
constexpr std::size_t kSparkColumns = 60;
constexpr std::size_t kFewest = 5;  // values that make a distribution

using StatusCounts = std::map<std::string, std::size_t>;

std::string words_for_status(std::string status) {
  std::replace(status.begin(), status.end(), '_', '-');
  return status;
}

std::string summary_of(const std::vector<BatchEntry>& entries, const StatusCounts& counts, std::size_t failures) {
  std::string sentence = fmt::format("{} {}", entries.size(), entries.size() == 1 ? "recording" : "recordings");
  const char* separator = ": ";
  for (const auto& [status, count] : counts) {
    sentence += fmt::format("{}{} {}", separator, count, words_for_status(status));
    separator = ", ";
  }
  if (failures > 0) sentence += fmt::format("; {} more could not be read", failures);
  return text(sentence + ".");
}

/// Equal steps of the logarithm: the quantities are positive and spread over decades.
std::optional<chart::Panel> histogram(std::vector<double> values, const std::string& label) {
  values.erase(std::remove_if(values.begin(), values.end(), [](double v) { return !(v > 0.0); }), values.end());
  if (values.size() < kFewest) return std::nullopt;
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
  panel.height_px = 110.0;
  panel.x = {label, first, first * std::exp(step * static_cast<double>(bins)), chart::Scale::Logarithmic};
  panel.y = {"recordings", 0.0, 1.1 * *std::max_element(counts.begin(), counts.end()), chart::Scale::Linear};
  for (std::size_t i = 0; i < bins; ++i) {
    const double left = first * std::exp(step * static_cast<double>(i));
    const double right = left * std::exp(step);
    panel.areas.push_back({"",
                           chart::Colour::Blue,
                           chart::Fill::Plain,
                           {{left, 0.0}, {left, counts[i]}, {right, counts[i]}, {right, 0.0}}});
  }
  return panel;
}

std::string distributions(const std::vector<BatchEntry>& entries) {
  const auto values = [&entries](Estimate BatchEntry::*quantity, double per_SI) {
    std::vector<double> found;
    for (const BatchEntry& entry : entries) {
      if ((entry.*quantity).value) found.push_back(per_SI * *(entry.*quantity).value);
    }
    return found;
  };
  chart::Chart chart{"Distributions", {}, {}};
  const auto add = [&chart](std::optional<chart::Panel> panel) {
    if (panel) chart.panels.push_back(std::move(*panel));
  };
  add(histogram(values(&BatchEntry::spacing_m, 1e3), "pattern spacing V/f [mm]"));
  add(histogram(values(&BatchEntry::frequency_Hz, 1.0), "frequency [Hz]"));
  add(histogram(values(&BatchEntry::stiffness_N_per_m, 1.0), "stiffness [N/m]"));
  add(histogram(values(&BatchEntry::damping_ratio, 1.0), "damping ratio [-]"));
  if (chart.panels.empty()) return {};
  return "<section>\n<h2>Distributions</h2>\n<p class=\"guide\">How many recordings show which value; only those in "
         "which "
         "it is known.</p>\n<figure>" +
         to_page_svg(chart, {"distributions", "histograms of spacing, frequency, stiffness and damping ratio"}) +
         "</figure>\n</section>\n";
}

std::string failures_part(const std::vector<BatchPageFailure>& failures) {
  if (failures.empty()) return {};
  std::string rows;
  for (const BatchPageFailure& failure : failures) {
    rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td><code>{}</code></td></tr>\n", text(failure.id),
                        text(failure.message), text(failure.code));
  }
  return "<section class=\"flows\">\n<h2>Failures</h2>\n<div class=\"wide\"><table id=\"failures\"><thead><tr><th "
         "scope=\"col\">recording</th><th scope=\"col\">what is wrong</th><th "
         "scope=\"col\">code</th></tr></thead><tbody>\n" +
         rows + "</tbody></table></div>\n</section>\n";
}

std::string table_of(const std::vector<BatchEntry>& entries) {
  std::string rows;
  for (std::size_t i = 0; i < std::min(kMostRows, entries.size()); ++i) rows += batch_row(entries[i]);
  return "<table id=\"recordings\">" + batch_headings() + "<tbody>\n" + rows + "</tbody></table>\n";
}

}  // namespace
}  // namespace html

std::vector<double> sparkline_of(const Recording& recording) {
  std::vector<double> heights;
  for (const chart::Point& point : html::envelope(recording.time_s(), recording.force(), html::kSparkColumns)) {
    heights.push_back(point.y);
  }
  return heights;
}

Result<std::string> to_html(const BatchPage& page) {
  std::vector<html::BatchEntry> entries;
  html::StatusCounts counts;
  for (const BatchPageRow& row : page.rows) {
    Result<html::BatchEntry> entry = html::batch_entry(row);
    if (!entry) return entry.error();
    entries.push_back(std::move(entry).value());
    ++counts[entries.back().status];
  }
  std::string statuses;
  for (const auto& [status, count] : counts) {
    statuses += fmt::format("<option value=\"{}\">{} ({})</option>", html::text(status),
                            html::text(html::words_for_status(status)), count);
  }
  const std::size_t left_out = entries.size() > html::kMostRows ? entries.size() - html::kMostRows : 0;
  return html::filled(
      assets::batch_page(),
      {{"title", html::text(page.title)},
       {"style", std::string(assets::style())},
       {"summary", html::summary_of(entries, counts, page.failures.size())},
       {"statuses", statuses},
       {"table", html::table_of(entries)},
       {"left_out", left_out > 0
                        ? fmt::format("<p>{} more recordings are in results.jsonl and not in this table.</p>", left_out)
                        : ""},
       {"distributions", html::distributions(entries)},
       {"failures", html::failures_part(page.failures)},
       {"footer", fmt::format("Made by slipfit {}.", SLIPFIT_VERSION)},
       {"script", std::string(assets::table_script())}});
}

}  // namespace slipfit
