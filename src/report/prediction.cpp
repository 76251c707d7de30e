#include "slipfit/report/prediction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>

#include "report/format.hpp"
#include "report/json_sections.hpp"
#include "report/json_values.hpp"
#include "report/names.hpp"
#include "report/quantities.hpp"
#include "report/text_sections.hpp"
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
  Json json{{"speed_m_per_s", row.speed_m_per_s}, {"regime", name_of(row.regime)}, {"bistable", is_bistable(row)}};
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
  return (is_bistable(row) ? "stick-slip, bistable" : plain_words(name_of(row.regime))) + mark;
}

bool is_in_text(const Quantity& quantity) {
  constexpr auto kShown =
      std::to_array<std::string_view>({"period_s", "frequency_Hz", "periodic_displacement_m", "sticking_degree"});
  return std::ranges::find(kShown, quantity.key) != kShown.end();
}

/// Each note of the rows once; the rows that it is about bear its mark.
class Footnotes {
 public:
  std::string mark(const std::string& note) {
    if (note.empty()) return {};
    const auto known = std::ranges::find(notes_, note);
    const auto index = static_cast<std::size_t>(known - notes_.begin());
    if (known == notes_.end()) notes_.push_back(note);
    return " " + std::string(index + 1, '*');
  }
  [[nodiscard]] std::string text() const {
    std::string text;
    for (std::size_t i = 0; i < notes_.size(); ++i) {
      text += wrapped_text(fmt::format("  {} ", std::string(i + 1, '*')), printable(notes_[i]));
    }
    return text;
  }

 private:
  std::vector<std::string> notes_;
};

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
  Table table({Align::Right, Align::Left, Align::Left, Align::Left, Align::Left, Align::Left});
  std::vector<std::string> head{"speed"};
  for (const auto& quantity : kMotionQuantities) {
    if (is_in_text(quantity)) head.emplace_back(quantity.words);
  }
  head.emplace_back("regime");
  table.add(std::move(head));
  Footnotes notes;
  bool has_bands = false;
  for (const PredictedMotion& row : prediction.rows) {
    std::vector<std::string> cells{quantity_text(row.speed_m_per_s, speed_unit(source.speed_unit, row.speed_m_per_s))};
    for (const auto& quantity : kMotionQuantities) {
      if (is_in_text(quantity)) cells.push_back(estimate_text(quantity.of(row), std::string(quantity.unit)));
    }
    cells.push_back(regime_words(row, notes.mark(row.note)));
    table.add(std::move(cells));
    has_bands = has_bands || row.lambda.ci95.has_value();
  }
  return fmt::format("Predicted from {}{}\n", printable(source.name),
                     has_bands ? ", [95 % interval of the mean cycle]" : "") +
         critical_speed_text(prediction.critical_speed_m_per_s, prediction.lambda_critical, source.speed_unit) +
         conditions_text(source.conditional_on) + "\n" + table.text() + notes.text() + warnings_text(source.warnings);
}

}  // namespace slipfit
