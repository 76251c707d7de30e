// Bytes as the FIT.json of slipfit predict and plan, and as a saved result: an answer, or an error of one line.
#include <array>
#include <nlohmann/json.hpp>

#include "demand.hpp"
#include "slipfit/report/fit_document.hpp"
#include "slipfit/report/plan.hpp"
#include "slipfit/report/prediction.hpp"
#include "slipfit/report/text.hpp"

namespace {

void plan(const std::string& content, const slipfit::PredictionSource& source) {
  const auto basis = slipfit::read_plan_basis(content, source.name);
  if (!basis) return fuzz::demand_readable(basis.error());
  const auto plan = slipfit::plan_next(basis.value(), std::nullopt);
  if (!plan) return fuzz::demand_readable(plan.error());
  fuzz::demand(nlohmann::json::accept(slipfit::to_json(plan.value(), source)), "a plan is JSON");
  (void)slipfit::to_text(plan.value(), source);
}

void summarise(const std::string& content) {
  const auto summary = slipfit::summary_of_document(content, "fit.json");
  if (!summary) fuzz::demand_readable(summary.error());
}

void predict_and_plan(const std::string& content) {
  const auto document = slipfit::read_fit_document(content, "fit.json");
  if (!document) return fuzz::demand_readable(document.error());
  const slipfit::PredictionSource source{"fit.json", document.value().conditional_on};
  constexpr std::array<double, 3> kSpeeds_m_per_s{1e-4, 0.01, 1.0};
  const slipfit::Prediction prediction = slipfit::predict_at(document.value().model, kSpeeds_m_per_s);
  fuzz::demand(nlohmann::json::accept(slipfit::to_json(prediction, source)), "a prediction is JSON");
  (void)slipfit::to_text(prediction, source);
  (void)slipfit::prediction_to_csv(prediction);
  plan(content, source);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string content(reinterpret_cast<const char*>(data), size);
  summarise(content);
  predict_and_plan(content);
  return 0;
}
