#include <string>

#include "report/json_values.hpp"
#include "report/predict_columns.hpp"
#include "slipfit/report/prediction.hpp"

namespace slipfit {
namespace {

Json quantity_json(const Estimate& quantity) {
  Json json{{"value", number(quantity.value)}, {"ci95", interval(quantity.ci95)}};
  if (!quantity.note.empty()) json["note"] = quantity.note;
  return json;
}

Json row_json(const PredictedMotion& row) {
  Json json{{"speed_m_per_s", number(row.speed_m_per_s)}, {"regime", row.regime}, {"bistable", row.bistable}};
  for (const PredictedQuantity& quantity : kPredictedQuantities) {
    json[std::string(quantity.name) + std::string(quantity.unit_suffix)] = quantity_json(row.*quantity.estimate);
  }
  if (!row.note.empty()) json["note"] = row.note;
  return json;
}

}  // namespace

std::string to_json(const Prediction& prediction, const PredictionSource& source) {
  Json rows = Json::array();
  for (const PredictedMotion& row : prediction.rows) rows.push_back(row_json(row));
  const Json json{{"schema", "slipfit.predict/1"},
                  {"version", SLIPFIT_VERSION},
                  {"source", source.name},
                  {"conditional_on", source.conditional_on},
                  {"critical_speed_m_per_s", quantity_json(prediction.critical_speed_m_per_s)},
                  {"lambda_critical", quantity_json(prediction.lambda_critical)},
                  {"rows", std::move(rows)}};
  return text_of(json);
}

}  // namespace slipfit
