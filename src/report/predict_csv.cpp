#include <fmt/format.h>

#include <iterator>
#include <optional>

#include "report/csv_cell.hpp"
#include "report/predict_columns.hpp"
#include "slipfit/report/prediction.hpp"

namespace slipfit {
namespace {

std::string header() {
  std::string text = "speed_m_per_s,regime,bistable";
  for (const PredictedQuantity& quantity : kPredictedQuantities) {
    text += fmt::format(",{0}{1},{0}_low{1},{0}_high{1}", quantity.name, quantity.unit_suffix);
  }
  return text + "\n";
}

}  // namespace

std::string prediction_to_csv(const Prediction& prediction) {
  std::string csv = header();
  for (const PredictedMotion& row : prediction.rows) {
    fmt::format_to(std::back_inserter(csv), "{},{},{}", cell(row.speed_m_per_s), row.regime, row.bistable ? 1 : 0);
    for (const PredictedQuantity& quantity : kPredictedQuantities) {
      const Estimate& estimate = row.*quantity.estimate;
      const auto low = estimate.ci95 ? std::optional(estimate.ci95->low) : std::nullopt;
      const auto high = estimate.ci95 ? std::optional(estimate.ci95->high) : std::nullopt;
      fmt::format_to(std::back_inserter(csv), ",{},{},{}", cell(estimate.value), cell(low), cell(high));
    }
    csv += "\n";
  }
  return csv;
}

}  // namespace slipfit
