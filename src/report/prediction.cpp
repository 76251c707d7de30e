#include "slipfit/report/prediction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>

#include "core/statistics.hpp"
#include "report/blocks.hpp"
#include "report/format.hpp"
#include "report/json_values.hpp"
#include "report/names.hpp"
#include "report/quantity_rows.hpp"
#include "slipfit/core/printable.hpp"
#include "slipfit/report/text.hpp"

namespace slipfit {
namespace {

Json quantity_json(const Estimate& quantity) {
  Json json{{"value", quantity.value}, {"ci95", quantity.ci95}};
  if (!quantity.note.empty()) json["note"] = quantity.note;
  return json;
}

bool is_bistable(const PredictedMotion& row) {
  return row.regime == Regime::StickSlipBistable;
}

Json row_json(const PredictedMotion& row) {
  Json json{{"speed_m_per_s", row.speed_m_per_s}, {"regime", row.regime}, {"bistable", is_bistable(row)}};
  for (const auto& quantity : kMotionQuantities) json[std::string(quantity.key)] = quantity_json(quantity.of(row));
  if (!row.note.empty()) json["note"] = row.note;
  return json;
}

std::string header() {
  std::string text = "speed_m_per_s,regime,bistable";
  for (const auto& quantity : kMotionQuantities) {
    text += fmt::format(",{},{},{}", quantity.key, key_of(quantity, "_low"), key_of(quantity, "_high"));
  }
  return text + "\n";
}

std::string regime_words(const PredictedMotion& row, const std::string& mark) {
  std::string words = is_bistable(row) ? "bistable" : plain_words(name_of(row.regime));
  constexpr std::string_view kSlip = " slip";  // "oscillatory" under "regime" keeps the table narrow
  if (words.ends_with(kSlip)) words.resize(words.size() - kSlip.size());
  return words + mark;
}

/// The columns of the text; the period is 1 / frequency.
constexpr auto kColumns =
    std::to_array<std::string_view>({"frequency_Hz", "sticking_degree", "periodic_displacement_m"});

/// Returns the unit that suits the median of the values.
DisplayUnit column_unit(const Prediction& prediction, const QuantityOf<PredictedMotion>& quantity) {
  std::vector<double> values;
  for (const PredictedMotion& row : prediction.rows) {
    if (const auto value = quantity.of(row).value) values.push_back(*value);
  }
  return display_unit(std::string(quantity.unit), values.empty() ? std::nullopt : std::optional(median(values)));
}

}  // namespace

std::string to_json(const Prediction& prediction, const PredictionSource& source) {
  const Json json{{"schema", "slipfit.predict/1"},
                  {"version", SLIPFIT_VERSION},
                  {"source", source.name},
                  {"conditional_on", source.conditional_on},
                  {"warnings", source.warnings},
                  {"critical_speed_m_per_s", quantity_json(prediction.critical_speed_m_per_s)},
                  {"lambda_critical", quantity_json(prediction.lambda_critical)},
                  {"rows", array_of(prediction.rows, row_json)}};
  return text_of(json);
}

std::string prediction_to_csv(const Prediction& prediction) {
  std::string csv = header();
  for (const PredictedMotion& row : prediction.rows) {
    fmt::format_to(std::back_inserter(csv), "{},{},{}", cell(row.speed_m_per_s), name_of(row.regime),
                   is_bistable(row) ? 1 : 0);
    for (const auto& quantity : kMotionQuantities) {
      const Estimate estimate = quantity.of(row);
      const auto low = estimate.ci95 ? std::optional(estimate.ci95->low) : std::nullopt;
      const auto high = estimate.ci95 ? std::optional(estimate.ci95->high) : std::nullopt;
      fmt::format_to(std::back_inserter(csv), ",{},{},{}", cell(estimate.value), cell(low), cell(high));
    }
    csv += "\n";
  }
  return csv;
}

std::string to_text(const Prediction& prediction, const PredictionSource& source) {
  std::vector<std::vector<std::string>> rows(prediction.rows.size() + 3);  // below a heading of three lines
  const auto add_column = [&](const std::string& words, const std::string& unit, const auto& cell_of) {
    const std::size_t blank = words.rfind(' ');
    rows[0].push_back(blank == std::string::npos ? "" : words.substr(0, blank));
    rows[1].push_back(words.substr(blank + 1));
    rows[2].push_back(unit.empty() ? unit : "[" + unit + "]");
    for (std::size_t i = 0; i < prediction.rows.size(); ++i) rows[i + 3].push_back(cell_of(prediction.rows[i]));
  };
  const DisplayUnit speed =
      speed_unit(source.speed_unit, prediction.rows.empty()
                                        ? std::nullopt
                                        : std::optional(prediction.rows[prediction.rows.size() / 2].speed_m_per_s));
  add_column("speed", speed.unit, [&](const PredictedMotion& row) {
    return quantity_text(row.speed_m_per_s, {speed.per_SI, {}});
  });
  for (const auto& quantity : kMotionQuantities) {
    if (std::ranges::find(kColumns, quantity.key) == kColumns.end()) continue;
    const DisplayUnit unit = column_unit(prediction, quantity);
    add_column(std::string(quantity.words), unit.unit, [&](const PredictedMotion& row) {
      return estimate_text(quantity.of(row), DisplayUnit{unit.per_SI, {}});
    });
  }
  Footnotes notes;
  add_column("regime", {}, [&](const PredictedMotion& row) { return regime_words(row, notes.mark(row.note)); });
  Table table({Align::Right, Align::Left, Align::Left, Align::Left, Align::Left});
  for (std::vector<std::string>& row : rows) table.add(std::move(row));
  const bool has_bands =
      std::ranges::any_of(prediction.rows, [](const PredictedMotion& row) { return row.lambda.ci95.has_value(); });
  return fmt::format("Predicted from {}{}\n", printable(source.name),
                     has_bands ? ", [95 % interval of the mean cycle]" : "") +
         critical_speed_text(prediction.critical_speed_m_per_s, prediction.lambda_critical, source.speed_unit) +
         conditions_text(source.conditional_on) + "\n" + table.text() +
         (std::ranges::any_of(prediction.rows, is_bistable)
              ? "  bistable: stick-slip from rest; steady sliding is stable as well\n"
              : "") +
         notes.text() + warnings_text(source.warnings);
}

}  // namespace slipfit
